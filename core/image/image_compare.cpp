// See image_compare.h. SSIM: Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error
// visibility to structural similarity", IEEE Transactions on Image Processing 13(4), 2004.
#include "core/image/image_compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/parallel.h"

namespace tessera {

namespace {

constexpr int kRadius = 5;
constexpr int kWindow = 2 * kRadius + 1;
constexpr size_t kRowGrain = 16;

double luma(const uint8_t* rgb) {
    return .299 * rgb[0] + .587 * rgb[1] + .114 * rgb[2];
}

double psnrOf(double meanSquare) {
    if (meanSquare == 0) return std::numeric_limits<double>::infinity();
    return 10 * std::log10(255.0 * 255.0 / meanSquare);
}

// What one row adds to the sums; rows are added up in order, so that threads leave no trace in the result.
struct RowSums {
    std::array<double, 3> absolute{};
    double square = 0;
    double euclid = 0;
    double lumaAbsolute = 0;
    double lumaSquare = 0;
};

RowSums sumRow(const uint8_t* a, const uint8_t* b, size_t width) {
    RowSums sums;
    for (size_t x = 0; x < width; ++x, a += 3, b += 3) {
        int square = 0;
        for (size_t c = 0; c < 3; ++c) {
            const int d = int(a[c]) - int(b[c]);
            sums.absolute[c] += std::abs(d);
            square += d * d;
        }
        sums.square += square;
        sums.euclid += std::sqrt(double(square));
        const double d = luma(a) - luma(b);
        sums.lumaAbsolute += std::abs(d);
        sums.lumaSquare += d * d;
    }
    return sums;
}

std::array<double, kWindow> gaussianWindow() {
    constexpr double kSigma = 1.5;
    std::array<double, kWindow> weights;
    double sum = 0;
    for (int i = -kRadius; i <= kRadius; ++i)
        sum += weights[size_t(i + kRadius)] = std::exp(-.5 * i * i / (kSigma * kSigma));
    for (double& weight : weights) weight /= sum;
    return weights;
}

// Windowed means of a, b, a^2, b^2 and ab.
struct Moments {
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    void add(double weight, const Moments& m) {
        a += weight * m.a;
        b += weight * m.b;
        aa += weight * m.aa;
        bb += weight * m.bb;
        ab += weight * m.ab;
    }
    double similarity() const {
        constexpr double kC1 = (.01 * 255) * (.01 * 255);
        constexpr double kC2 = (.03 * 255) * (.03 * 255);
        return (2 * a * b + kC1) * (2 * (ab - a * b) + kC2) /
               ((a * a + b * b + kC1) * ((aa - a * a) + (bb - b * b) + kC2));
    }
};

double meanSsim(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b, size_t width, size_t height) {
    const std::array<double, kWindow> weights = gaussianWindow();
    const size_t rows = height - kWindow + 1;
    const size_t columns = width - kWindow + 1;
    std::vector<double> rowSums(rows);
    parallelFor(rows, kRowGrain, [&](size_t begin, size_t end) {
        std::vector<Moments> vertical(width);
        for (size_t y = begin; y < end; ++y) {
            std::ranges::fill(vertical, Moments{});
            for (size_t i = 0; i < kWindow; ++i) {
                const uint8_t* pa = &a[(y + i) * width * 3];
                const uint8_t* pb = &b[(y + i) * width * 3];
                for (size_t x = 0; x < width; ++x, pa += 3, pb += 3) {
                    const double la = luma(pa);
                    const double lb = luma(pb);
                    vertical[x].add(weights[i], {la, lb, la * la, lb * lb, la * lb});
                }
            }
            double sum = 0;
            for (size_t x = 0; x < columns; ++x) {
                Moments window;
                for (size_t i = 0; i < kWindow; ++i) window.add(weights[i], vertical[x + i]);
                sum += window.similarity();
            }
            rowSums[y] = sum;
        }
    });
    double sum = 0;
    for (const double row : rowSums) sum += row;
    return sum / (double(rows) * double(columns));
}

std::string sizeOf(const Image& image) {
    return std::to_string(image.width()) + " x " + std::to_string(image.height());
}

}  // namespace

std::vector<uint8_t> rgb8OverWhite(const Image& image) {
    std::vector<uint8_t> rgb(image.planeSize() * 3);
    parallelFor(image.planeSize(), 16384, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const float alpha = image.hasAlpha() ? image.plane(3)[i] : 1;
            const float white = alpha < 1 ? 1 - std::max(alpha, 0.f) : 0;
            for (int c = 0; c < 3; ++c) {
                const float value = image.plane(c)[i] + white;
                // The first comparison is false for NaN too.
                rgb[3 * i + size_t(c)] = uint8_t(value > 0 ? std::lround(std::min(value, 1.f) * 255) : 0);
            }
        }
    });
    return rgb;
}

Result<ImageDifference> compareImages(const Image& a, const Image& b) {
    if (a.empty() || b.empty() || a.channels() < 3 || b.channels() < 3)
        return failure(ErrorCode::Usage,
                       "cannot compare an empty picture; give two pictures of the same size");
    if (a.width() != b.width() || a.height() != b.height())
        return failure(ErrorCode::Usage, "cannot compare pictures of " + sizeOf(a) + " and " + sizeOf(b) +
                                             " pixels; scale one to the size of the other");
    const auto width = size_t(a.width());
    const auto height = size_t(a.height());
    const std::vector<uint8_t> pixelsA = rgb8OverWhite(a);
    const std::vector<uint8_t> pixelsB = rgb8OverWhite(b);
    std::vector<RowSums> rows(height);
    parallelFor(height, kRowGrain, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            rows[y] = sumRow(&pixelsA[y * width * 3], &pixelsB[y * width * 3], width);
    });
    RowSums total;
    for (const RowSums& row : rows) {
        for (size_t c = 0; c < 3; ++c) total.absolute[c] += row.absolute[c];
        total.square += row.square;
        total.euclid += row.euclid;
        total.lumaAbsolute += row.lumaAbsolute;
        total.lumaSquare += row.lumaSquare;
    }
    const double pixels = double(width) * double(height);
    ImageDifference difference;
    for (size_t c = 0; c < 3; ++c) {
        difference.maeChannel[c] = total.absolute[c] / pixels;
        difference.mae += difference.maeChannel[c] / 3;
    }
    const double meanSquare = total.square / (3 * pixels);
    difference.euclid = total.euclid / pixels;
    difference.rmse = std::sqrt(meanSquare);
    difference.psnr = psnrOf(meanSquare);
    difference.maeLuma = total.lumaAbsolute / pixels;
    difference.psnrLuma = psnrOf(total.lumaSquare / pixels);
    if (std::min(a.width(), a.height()) >= kWindow)
        difference.ssim = meanSsim(pixelsA, pixelsB, width, height);
    return difference;
}

}  // namespace tessera
