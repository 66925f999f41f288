// The profile of a blurred feature: what a step becomes under a Gaussian, with an end.
#pragma once

#include <algorithm>
#include <cmath>

namespace tessera {

// The largest sigma that a feature may have, px: with wider ones each patch would reckon with all features.
constexpr double kWidestBlurPx = 64;
// Beyond this many sigmas from its curve a feature changes nothing.
constexpr double kBlurReach = 3;
// A feature's blur fades out over this many sigmas of arc length before a free tip or a junction.
constexpr double kBlurFade = 4;

inline double smoothStep(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// The share of the other side's colour at `x` = distance / sigma >= 0: Phi(-x), which is 1/2 on the curve,
// brought to 0 between 2 and kBlurReach.
inline double blurShare(double x) {
    if (x >= kBlurReach) return 0;
    return .5 * std::erfc(x * .70710678118654752440) * (1 - smoothStep(2, kBlurReach, x));
}

// How much of a jump is blurred at `arc` px of arc length from a free tip or a junction: 0 there, 1 from
// kBlurFade * sigma on.
inline double blurFade(double arc, double sigma) {
    return sigma > 0 ? smoothStep(0, kBlurFade * sigma, arc) : 1;
}

}  // namespace tessera
