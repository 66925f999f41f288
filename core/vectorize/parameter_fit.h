// The squared error of the best polynomial in a patch's own parameters: what curved edges are chosen by. The
// splines live in the parametric domain, so a bend that suits the picture but makes the patch's Jacobian
// uneven costs them what it gains; a polynomial in image coordinates (polynomial_fit.h) does not see that.
#pragma once

#include <stop_token>
#include <vector>

#include "core/image/image.h"
#include "core/mesh/bezier.h"

namespace tessera {

class ParameterFit {
  public:
    static constexpr int kDegree = 5;
    static constexpr int kTerms = (kDegree + 1) * (kDegree + 2) / 2;

    // Keeps a smoothed copy of the picture (16 bytes a pixel); incomplete where `stop` is asked for
    // meanwhile.
    explicit ParameterFit(const Image& picture, const std::stop_token& stop = {});

    // Sum over all channels of the squared difference from a polynomial of degree kDegree in the patch's
    // parameters, integrated over the patch and kGrowPx around it, in square px; about what the best one
    // leaves of the picture less its noise. Measured at about one place a pixel, the same in parameters for
    // all patches with the same corners. Thread-safe; the same on every machine.
    double error(const LatticeTriangle& patch) const;

  private:
    // Places in the domain, spread evenly, with the polynomials orthonormal over them.
    struct Places {
        explicit Places(int perSide);
        size_t padded;                  // their number, rounded up to whole vectors
        std::vector<float> cubic;       // 10 rows: Bernstein polynomials by control point
        std::vector<float> quadratic;   // 6 rows
        std::vector<float> polynomial;  // kTerms rows; 0 in the padding
    };
    template <int kChannels>
    double errorOf(const LatticeTriangle& patch, const Places& places, double growth) const;

    int mWidth, mHeight, mChannels;
    std::vector<float> mPixels;   // kMaxChannels each; a row and a column are repeated at the far ends
    std::vector<Places> mPlaces;  // for 6, 8, ... 48 rows of them
};

}  // namespace tessera
