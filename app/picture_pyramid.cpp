// See picture_pyramid.h.
#include "app/picture_pyramid.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace tessera {

namespace {

constexpr int kSmallestLevelPx = 256;

uint to8Bit(float value) {
    return uint(std::clamp(value, 0.f, 1.f) * 255.f + .5f);
}

}  // namespace

QImage toQImage(const Image& image) {
    if (image.empty()) return {};
    QImage result(image.width(), image.height(),
                  image.hasAlpha() ? QImage::Format_ARGB32_Premultiplied : QImage::Format_RGB32);
    // The planes are taken once: bits() would copy a shared image at each call from another thread.
    auto* const pixels = reinterpret_cast<QRgb*>(result.bits());
    const auto stride = size_t(result.bytesPerLine()) / sizeof(QRgb);
    const auto width = size_t(image.width());
    const auto red = image.plane(0), green = image.plane(1), blue = image.plane(2);
    parallelFor(size_t(image.height()), 32, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            for (size_t x = 0; x < width; ++x) {
                const size_t i = y * width + x;
                const uint alpha = image.hasAlpha() ? to8Bit(image.plane(3)[i]) : 255;
                // Premultiplied values above alpha are what Qt's blending must never see.
                pixels[y * stride + x] =
                    qRgba(int(std::min(to8Bit(red[i]), alpha)), int(std::min(to8Bit(green[i]), alpha)),
                          int(std::min(to8Bit(blue[i]), alpha)), int(alpha));
            }
    });
    return result;
}

PicturePyramid::PicturePyramid(QImage picture) {
    mLevels.push_back(std::move(picture));
    while (std::max(mLevels.back().width(), mLevels.back().height()) > kSmallestLevelPx) {
        const QImage& last = mLevels.back();
        mLevels.push_back(last.scaled((last.width() + 1) / 2, (last.height() + 1) / 2, Qt::IgnoreAspectRatio,
                                      Qt::SmoothTransformation));
    }
}

const QImage& PicturePyramid::levelFor(double scale) const {
    size_t level = 0;
    while (level + 1 < mLevels.size() && scale <= .5) {
        scale *= 2;
        ++level;
    }
    return mLevels[level];
}

}  // namespace tessera
