// See thumbnail.h.
#include "ui/thumbnail.h"

#include <QFile>
#include <QImageReader>
#include <span>

#include "app/picture_pyramid.h"
#include "core/document/codec.h"
#include "core/image/image_io.h"

namespace tessera {

namespace {

// A picture that takes longer than a person waits for a thumbnail goes without.
constexpr ReadLimits kLimits{.maxPixels = 60'000'000};

QImage scaledTo(const QImage& image, QSize bounds) {
    if (image.isNull() || (image.width() <= bounds.width() && image.height() <= bounds.height()))
        return image;
    return image.scaled(bounds, Qt::KeepAspectRatio, Qt::SmoothTransformation);
}

QImage previewIn(std::span<const uint8_t> document) {
    const auto png = readPreview(document);
    return png ? QImage::fromData(QByteArrayView(png->data(), qsizetype(png->size())), "PNG") : QImage();
}

// JPEG files are decoded at a fraction of their size.
QImage pictureIn(QFile& file, QSize bounds) {
    QImageReader reader(&file);
    reader.setDecideFormatFromContent(true);
    reader.setAutoTransform(true);
    const QSize size = reader.size();
    if (size.isValid() && uint64_t(size.width()) * uint64_t(size.height()) > kLimits.maxPixels) return {};
    if (size.isValid()) {
        // The transformation may turn the picture: room enough either way round.
        const int side = std::max(bounds.width(), bounds.height());
        if (size.width() > side || size.height() > side)
            reader.setScaledSize(size.scaled(side, side, Qt::KeepAspectRatio));
    }
    return reader.read();
}

}  // namespace

QImage thumbnailOf(const QString& path, QSize bounds) {
    QFile file(path);
    if (!file.open(QIODevice::ReadOnly)) return {};
    const QByteArray head = file.peek(16);
    const auto bytesOf = [](const QByteArray& bytes) {
        return std::span(reinterpret_cast<const uint8_t*>(bytes.data()), size_t(bytes.size()));
    };
    if (looksLikeDocument(bytesOf(head))) {
        const QByteArray all = file.readAll();
        return scaledTo(previewIn(bytesOf(all)), bounds);
    }
    QImage picture = pictureIn(file, bounds);
    // What Qt does not read, core may: TIFF, EXR and others.
    if (picture.isNull())
        if (const auto loaded = readImage(path.toStdString(), kLimits)) picture = toQImage(loaded->image);
    return scaledTo(picture, bounds);
}

}  // namespace tessera
