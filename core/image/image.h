// A picture as planes of floats in the working space of the fit: gamma-encoded sRGB, 0..1 but not clamped,
// premultiplied by alpha.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/unset_allocator.h"

namespace tessera {

// Planar: plane c is `height` rows of `width` floats. 3 channels (R, G, B), or 4 with alpha where the picture
// is not opaque. Pixel (x, y) covers [x, x + 1] x [y, y + 1]; its centre is (x + .5, y + .5), y down.
class Image {
  public:
    Image() = default;
    Image(int width, int height, int channels, float value = 0)
        : mWidth(width), mHeight(height), mChannels(channels), mData(planeSize() * size_t(channels), value) {}

    // One whose values are yet to be set, all of them: memory that is not cleared first.
    static Image unset(int width, int height, int channels) {
        Image image;
        image.mWidth = width;
        image.mHeight = height;
        image.mChannels = channels;
        image.mData.resize(image.planeSize() * size_t(channels));
        return image;
    }

    int width() const { return mWidth; }
    int height() const { return mHeight; }
    int channels() const { return mChannels; }
    bool empty() const { return mData.empty(); }
    bool hasAlpha() const { return mChannels == 4; }
    size_t planeSize() const { return size_t(mWidth) * size_t(mHeight); }

    std::span<float> plane(int c) { return {mData.data() + planeSize() * size_t(c), planeSize()}; }
    std::span<const float> plane(int c) const {
        return {mData.data() + planeSize() * size_t(c), planeSize()};
    }

    float& at(int x, int y, int c) { return mData[index(x, y, c)]; }
    float at(int x, int y, int c) const { return mData[index(x, y, c)]; }

    bool operator==(const Image&) const = default;

  private:
    size_t index(int x, int y, int c) const {
        return planeSize() * size_t(c) + size_t(y) * size_t(mWidth) + size_t(x);
    }

    int mWidth = 0;
    int mHeight = 0;
    int mChannels = 0;
    std::vector<float, UnsetAllocator<float>> mData;
};

// The value of plane c at image point (x, y) by bilinear interpolation of the pixel centres; outside the
// picture that of the nearest point of its outermost centres.
float bilinear(const Image& image, int c, double x, double y);

}  // namespace tessera
