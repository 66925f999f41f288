// The photo that a document was made from, as the window uses it.
#pragma once

#include <QString>
#include <cstdint>
#include <memory>
#include <vector>

#include "app/picture_pyramid.h"
#include "core/image/image.h"

namespace tessera {

// In the forms in which it is used; all null where it is not known.
struct Photo {
    std::shared_ptr<const Image> image = {};
    std::shared_ptr<const PicturePyramid> pyramid = {};
    std::shared_ptr<const std::vector<uint8_t>> bytes = {};  // of its file, for documents to embed
    QString path = {};                                       // of its file, which may be gone

    // What the image takes, in bytes.
    size_t imageBytes() const {
        return image ? size_t(image->width()) * size_t(image->height()) * size_t(image->channels()) *
                           sizeof(float)
                     : 0;
    }
};

}  // namespace tessera
