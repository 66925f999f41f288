// The squared error of the best polynomial over the pixels of a triangle: what the true-error stage compares
// meshes by. A quintic follows a picture about as well as a patch's spline does, and its
// normal equations come from sums along rows.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "core/image/image.h"

namespace tessera {

class PolynomialFit {
  public:
    static constexpr int kDegree = 5;
    static constexpr int kTerms = (kDegree + 1) * (kDegree + 2) / 2;

    // Copies the picture (16 bytes a pixel).
    explicit PolynomialFit(const Image& picture);

    int width() const { return mWidth; }
    int height() const { return mHeight; }

    // Sum over the pixels whose centres lie inside `outline` and over all channels of the squared difference
    // from the best polynomial of degree kDegree. `outline` is a simple polygon in px; `corners` are those of
    // the triangle that it bounds. Thread-safe.
    double error(const std::array<glm::dvec2, 3>& corners, std::span<const glm::dvec2> outline) const;
    double error(const std::array<glm::dvec2, 3>& corners) const { return error(corners, corners); }

  private:
    struct Sums;
    void addRun(int y, int begin, int end, Sums& sums) const;

    int mWidth, mHeight, mChannels;
    size_t mStride;
    std::vector<float> mPixels;                                // planes of rows, padded for whole vectors
    std::vector<std::array<double, kDegree + 1>> mEvenPowers;  // by run length: sums of u^0, u^2, ... u^8
};

}  // namespace tessera
