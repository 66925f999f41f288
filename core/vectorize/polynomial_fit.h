// The squared error of the best polynomial over the pixels of a triangle: what the true-error stage compares
// meshes by. A quintic follows a picture about as well as a patch's spline does, and its
// normal equations come from sums along columns.
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

    // Copies the picture, of 3 or 4 channels (4 bytes a pixel and channel).
    explicit PolynomialFit(const Image& picture);

    int width() const { return mWidth; }
    int height() const { return mHeight; }

    // Sum over the pixels whose centres lie inside `outline` and over all channels of the squared difference
    // from the best polynomial of degree kDegree; 0 where there are none. `outline` is a simple polygon in
    // px; `corners` are those of the triangle that it bounds. Thread-safe.
    double error(const std::array<glm::dvec2, 3>& corners, std::span<const glm::dvec2> outline) const;
    double error(const std::array<glm::dvec2, 3>& corners) const { return error(corners, corners); }

  private:
    size_t index(int x, int y, int c) const;

    int mWidth, mHeight, mChannels;
    std::vector<float> mPixels;  // strips of columns, see polynomial_fit.cpp
};

}  // namespace tessera
