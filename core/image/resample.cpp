// See resample.h. Keys, "Cubic convolution interpolation for digital image processing", IEEE Transactions on
// Acoustics, Speech, and Signal Processing 29(6), 1981; Irani and Peleg, "Improving resolution by image
// registration", CVGIP: Graphical Models and Image Processing 53(3), 1991.
#include "core/image/resample.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace tessera {

Image boxDownsample(const Image& image, int factor) {
    TESSERA_CHECK(factor >= 1 && factor <= std::min(image.width(), image.height()));
    Image small(image.width() / factor, image.height() / factor, image.channels());
    parallelFor(size_t(small.height()), 16, [&](size_t begin, size_t end) {
        for (int c = 0; c < small.channels(); ++c)
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < small.width(); ++x) {
                    double sum = 0;
                    for (int j = 0; j < factor; ++j)
                        for (int i = 0; i < factor; ++i) sum += image.at(x * factor + i, y * factor + j, c);
                    small.at(x, y, c) = float(sum / (factor * factor));
                }
    });
    return small;
}

Image cropped(const Image& image, int width, int height) {
    TESSERA_CHECK(width <= image.width() && height <= image.height());
    Image part(width, height, image.channels());
    for (int c = 0; c < part.channels(); ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) part.at(x, y, c) = image.at(x, y, c);
    return part;
}

Image upsample(const Image& image, int factor, ResampleFilter filter) {
    Image large(image.width() * factor, image.height() * factor, image.channels());
    for (int c = 0; c < image.channels(); ++c) {
        // cv::Mat has no view of constant data; resize only reads it.
        const cv::Mat from(image.height(), image.width(), CV_32F, const_cast<float*>(image.plane(c).data()));
        cv::Mat to(large.height(), large.width(), CV_32F, large.plane(c).data());
        cv::resize(from, to, to.size(), 0, 0,
                   filter == ResampleFilter::Bicubic ? cv::INTER_CUBIC : cv::INTER_LANCZOS4);
    }
    return large;
}

Image enlargedMeans(const Image& image, int factor, const std::stop_token& stop) {
    constexpr int kRounds = 4;
    Image large = upsample(image, factor, ResampleFilter::Bicubic);
    for (int round = 0; round < kRounds && !stop.stop_requested(); ++round) {
        Image left = boxDownsample(large, factor);
        for (int c = 0; c < image.channels(); ++c)
            for (size_t i = 0; i < image.planeSize(); ++i)
                left.plane(c)[i] = image.plane(c)[i] - left.plane(c)[i];
        const Image correction = upsample(left, factor, ResampleFilter::Bicubic);
        for (int c = 0; c < image.channels(); ++c)
            for (size_t i = 0; i < large.planeSize(); ++i) large.plane(c)[i] += correction.plane(c)[i];
    }
    return large;
}

}  // namespace tessera
