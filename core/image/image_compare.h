// How far two pictures are apart, by the usual measures. All on 8-bit sRGB values, 0..255.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace tessera {

// PSNR is infinite for equal pictures. SSIM is Wang et al. 2004 on Rec. 601 luma (Gaussian window 11x11,
// sigma 1.5, K1 .01, K2 .03, L 255, mean over the windows that lie inside) and missing below 11 pixels.
struct ImageDifference {
    double mae = 0;                      // mean |d| over pixels and channels
    std::array<double, 3> maeChannel{};  // the same per channel
    double euclid = 0;                   // mean Euclidean RGB distance
    double rmse = 0;
    double psnr = 0;
    double maeLuma = 0;
    double psnrLuma = 0;
    std::optional<double> ssim;
};

// Interleaved RGB composed over white, rounded to 8 bits: the values that are compared.
std::vector<uint8_t> rgb8OverWhite(const Image& image);

// Both images are composed over white and rounded to 8 bits first. Fails with Usage where the sizes differ.
Result<ImageDifference> compareImages(const Image& a, const Image& b);

}  // namespace tessera
