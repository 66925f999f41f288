// The opponent basis: its formula, that it is orthonormal, and the way back.
#include "core/mesh/colour_basis.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace tessera {
namespace {

using Plane = std::vector<float>;

struct Planes {
    std::array<Plane, 3> p;
    std::array<float*, 3> pointers() { return {p[0].data(), p[1].data(), p[2].data()}; }
};

Planes somePlanes() {
    Planes s;
    for (int i = 0; i < 37; ++i) {
        s.p[0].push_back(.03f * float(i) - .2f);
        s.p[1].push_back(1 - .01f * float(i * i % 50));
        s.p[2].push_back(.5f * std::sin(float(i)));
    }
    return s;
}

TEST(ColourBasis, OpponentIsItsFormula) {
    const Planes rgb = somePlanes();
    Planes s = rgb;
    fromWorking(ColourBasis::Opponent, s.pointers().data(), s.p[0].size());
    for (size_t i = 0; i < s.p[0].size(); ++i) {
        const double r = double(rgb.p[0][i]), g = double(rgb.p[1][i]), b = double(rgb.p[2][i]);
        EXPECT_NEAR(double(s.p[0][i]), (r + g + b) / std::sqrt(3.0), 1e-6);
        EXPECT_NEAR(double(s.p[1][i]), (r - b) / std::sqrt(2.0), 1e-6);
        EXPECT_NEAR(double(s.p[2][i]), (r - 2 * g + b) / std::sqrt(6.0), 1e-6);
    }
}

TEST(ColourBasis, OpponentKeepsLengthsAndLeadsBack) {
    const Planes rgb = somePlanes();
    Planes s = rgb;
    const auto squares = [](const Planes& q, size_t i) {
        double sum = 0;
        for (const Plane& plane : q.p) sum += double(plane[i]) * double(plane[i]);
        return sum;
    };
    fromWorking(ColourBasis::Opponent, s.pointers().data(), s.p[0].size());
    for (size_t i = 0; i < s.p[0].size(); ++i) EXPECT_NEAR(squares(s, i), squares(rgb, i), 1e-6);
    toWorking(ColourBasis::Opponent, s.pointers().data(), s.p[0].size());
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < s.p[c].size(); ++i) EXPECT_NEAR(s.p[c][i], rgb.p[c][i], 1e-6);
}

TEST(ColourBasis, RgbIsTheWorkingSpace) {
    Planes s = somePlanes();
    toWorking(ColourBasis::Rgb, s.pointers().data(), s.p[0].size());
    fromWorking(ColourBasis::Rgb, s.pointers().data(), s.p[0].size());
    EXPECT_EQ(s.p, somePlanes().p);
}

}  // namespace
}  // namespace tessera
