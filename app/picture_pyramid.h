// Pictures as Qt draws them, and the halved copies that make a large photo quick to draw when it is shown
// small.
#pragma once

#include <QImage>
#include <memory>
#include <vector>

#include "core/image/image.h"

namespace tessera {

// The image with 8 bits a channel, clamped: RGB32, or premultiplied ARGB32 where it has alpha. Null for an
// empty one.
QImage toQImage(const Image& image);

// Level 0 is the picture itself, each further level half as wide and high (rounded up), down to about 256
// pixels.
class PicturePyramid {
  public:
    explicit PicturePyramid(QImage picture);

    const QImage& full() const { return mLevels.front(); }
    // The smallest level that still has at least one pixel for each of the screen's at `scale` screen pixels
    // per picture pixel.
    const QImage& levelFor(double scale) const;

  private:
    std::vector<QImage> mLevels;
};

}  // namespace tessera
