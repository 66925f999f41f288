// The certificate that a patch does not fold: its coefficients against det J, its answers against samples.
#include "core/mesh/jacobian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/mesh/patch_mesh.h"

namespace tessera {
namespace {

constexpr int kPx = kLatticePerPixel;

// Control points from a function of the exponents (i, j, k), in pixels.
template <class Place>
LatticeTriangle patchOf(Place&& place) {
    LatticeTriangle t;
    for (int i = 0; i <= 3; ++i)
        for (int j = 0; i + j <= 3; ++j)
            t.p[size_t(controlIndex(i, j, 3 - i - j))] = toLattice(place(i, j, 3 - i - j));
    return t;
}

// The straight patch with these corners; exact on the lattice where their coordinates are multiples of 3 px.
LatticeTriangle affine(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return patchOf(
        [&](int i, int j, int k) { return (double(i) * a + double(j) * b + double(k) * c) / 3.0; });
}

// x depends on v alone, as the cubic with these control values, and y on w alone: det J = x'(v) y'(w).
LatticeTriangle productPatch(const std::array<double, 4>& x) {
    return patchOf([&](int, int j, int k) { return glm::dvec2(x[size_t(j)], 4.0 * k); });
}

// The smallest det J, relative to the base triangle, at the points of a regular grid.
double smallestSample(const LatticeTriangle& lattice, int n) {
    const BezierTriangle t = toPixels(lattice);
    const double base = cross(t.corner(1) - t.corner(0), t.corner(2) - t.corner(0));
    double smallest = HUGE_VAL;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const PatchPoint p =
                evaluateWithDerivatives(t, {double(i) / n, double(j) / n, double(n - i - j) / n});
            smallest = std::min(smallest, cross(p.dv, p.dw) / base);
        }
    return smallest;
}

LatticeTriangle randomPatch(std::mt19937& random, double most) {
    std::uniform_real_distribution<double> off(-most, most);
    LatticeTriangle t = affine({3, 3}, {27, 6}, {12, 24});
    for (LatticePoint& p : t.p) p = p + toLattice({off(random), off(random)});
    return t;
}

TEST(JacobianBernstein, AffinePatchHasOnesEverywhere) {
    for (const double c : jacobianBernstein(affine({0, 0}, {9, 3}, {3, 12}))) EXPECT_DOUBLE_EQ(c, 1);
    EXPECT_DOUBLE_EQ(minBernstein(affine({0, 0}, {9, 3}, {3, 12})), 1);
}

TEST(JacobianBernstein, IsTheDeterminantInBernsteinForm) {
    constexpr int kFactorial[] = {1, 1, 2, 6, 24};
    std::mt19937 random(7);
    for (int round = 0; round < 50; ++round) {
        const LatticeTriangle lattice = randomPatch(random, 6);
        const auto coefficients = jacobianBernstein(lattice);
        const BezierTriangle t = toPixels(lattice);
        const double base = cross(t.corner(1) - t.corner(0), t.corner(2) - t.corner(0));
        for (int a = 0; a <= 10; ++a)
            for (int b = 0; a + b <= 10; ++b) {
                const Barycentric at(a / 10.0, b / 10.0, (10 - a - b) / 10.0);
                double sum = 0;
                for (int i = 0; i <= 4; ++i)
                    for (int j = 0; i + j <= 4; ++j)
                        sum += coefficients[size_t(quarticIndex(i, j))] * 24 /
                               (kFactorial[i] * kFactorial[j] * kFactorial[4 - i - j]) * std::pow(at.x, i) *
                               std::pow(at.y, j) * std::pow(at.z, 4 - i - j);
                const PatchPoint p = evaluateWithDerivatives(t, at);
                EXPECT_NEAR(sum, cross(p.dv, p.dw) / base, 1e-10);
            }
    }
}

TEST(JacobianBernstein, IndicesAreAllDifferent) {
    std::array<int, 15> seen{};
    for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j) ++seen[size_t(quarticIndex(i, j))];
    for (const int n : seen) EXPECT_EQ(n, 1);
}

TEST(Certified, StraightTriangles) {
    EXPECT_TRUE(certified(affine({0, 0}, {9, 0}, {0, 9})));
    EXPECT_FALSE(certified(affine({0, 0}, {0, 9}, {9, 0}))) << "negative orientation";
    EXPECT_FALSE(certified(affine({0, 0}, {9, 0}, {18, 0}))) << "no area";
    EXPECT_EQ(minBernstein(affine({0, 0}, {0, 9}, {9, 0})), -1);
}

LatticeTriangle straight(LatticePoint a, LatticePoint b, LatticePoint c) {
    LatticeTriangle t;
    size_t k = 0;
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
        const auto inner = straightControlPoints(from, to);
        for (const LatticePoint p : {from, inner[0], inner[1]}) t.p[k++] = p;
    }
    return t;
}

TEST(CertifiedIfStraight, HoldsForTrianglesJustHighEnough) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    int low = 0, high = 0;
    for (int i = 0; i < 20000; ++i) {
        // From a base as short as the height to one of 1000 px.
        const double base = 30 * std::pow(8500, unit(random)), height = 20 + 10 * unit(random);
        const double angle = 6.3 * unit(random), foot = base * unit(random);
        const glm::dvec2 along(std::cos(angle), std::sin(angle)), up(-along.y, along.x);
        const auto at = [&](double x, double y) {
            return toLattice((x * along + y * up) / double(kLatticePerPixel));
        };
        const LatticePoint a = at(0, 0), b = at(base, 0), c = at(foot, height);
        const LatticeTriangle t = straight(a, b, c);
        if (!certifiedIfStraight(a, b, c)) {
            ++low;
            continue;
        }
        ++high;
        LatticeTriangle usual = t;
        usual.p[kInterior] = toLattice(defaultInterior(toPixels(t)));
        EXPECT_TRUE(certified(usual)) << base << ' ' << height << ' ' << angle;
    }
    EXPECT_GT(low, 5000);
    EXPECT_GT(high, 5000);
}

TEST(CertifiedIfStraight, RefusesWhatRoundingFolds) {
    EXPECT_FALSE(certifiedIfStraight({0, 0}, {1, 0}, {0, 900}));
    EXPECT_FALSE(certifiedDefaultInterior(straight({0, 0}, {1, 0}, {0, 900})));
    EXPECT_FALSE(certifiedIfStraight({0, 0}, {0, 900}, {900, 0})) << "negative orientation";
}

// x' has the Bernstein coefficients 3 (4, -3, 4); its least value, in the middle, is a quarter of (1, 2, 1)
// times those.
TEST(Certified, DecidesBySubdivisionWhereCoefficientsAreMixed) {
    const LatticeTriangle t = productPatch({0, 4, 1, 5});
    EXPECT_LT(minBernstein(t), 0);
    EXPECT_NEAR(smallestSample(t, 40), 1.5 / 5, 1e-12);
    EXPECT_TRUE(certified(t));
}

TEST(Certified, RefusesWhereTheDeterminantTouchesOrPassesZeroInside) {
    EXPECT_FALSE(certified(productPatch({0, 4, 0, 4}))) << "x'(1/2) = 0";
    EXPECT_FALSE(certified(productPatch({0, 4, -1, 3}))) << "x'(1/2) < 0";
}

TEST(Certified, RefusesACuspAtACorner) {
    LatticeTriangle t = affine({0, 0}, {9, 0}, {0, 9});
    t.p[1] = t.p[0];  // the side's derivative vanishes at corner a
    EXPECT_FALSE(certified(t));
    EXPECT_LE(minBernstein(t), 0);
}

TEST(Certified, RefusesAFoldByASideBentOverTheOthers) {
    LatticeTriangle t = affine({0, 0}, {9, 0}, {3, 6});
    t.p[1] = {3 * kPx, 12 * kPx};
    t.p[2] = {6 * kPx, 12 * kPx};
    EXPECT_LT(smallestSample(t, 20), 0);
    EXPECT_FALSE(certified(t));
}

// The exact answer never says yes where a sample says no; and says yes wherever the determinant is well above
// zero.
TEST(Certified, AgreesWithDenseSamples) {
    std::mt19937 random(3);
    int yes = 0, no = 0, subdivided = 0;
    for (int round = 0; round < 3000; ++round) {
        const LatticeTriangle t = randomPatch(random, 1.5 + 3.5 * (round % 8) / 7);
        const double smallest = smallestSample(t, 24);
        if (certified(t)) {
            ++yes;
            EXPECT_GT(smallest, 0);
            subdivided += minBernstein(t) <= 0;
        } else {
            ++no;
            EXPECT_LT(smallest, .02) << "left open although the determinant is positive";
        }
    }
    EXPECT_GT(yes, 300);
    EXPECT_GT(no, 100);
    EXPECT_GT(subdivided, 10);
}

TEST(Certified, DoesNotDependOnWhichCornerIsFirst) {
    std::mt19937 random(5);
    for (int round = 0; round < 300; ++round) {
        const LatticeTriangle t = randomPatch(random, 3.5);
        LatticeTriangle turned = t;
        std::rotate(turned.p.begin(), turned.p.begin() + 3, turned.p.begin() + 9);
        // A patch at the limit of depth may be left open in one orientation alone; there is none among these.
        EXPECT_EQ(certified(t), certified(turned));
    }
}

TEST(CertifiedInterior, KeepsThePresentPointWhereItIsGood) {
    LatticeTriangle t = affine({0, 0}, {9, 0}, {0, 9});
    t.p[kInterior] = t.p[kInterior] + LatticePoint{50, -30};
    ASSERT_TRUE(certified(t));
    EXPECT_EQ(certifiedInterior(t), t.p[kInterior]);
}

TEST(CertifiedInterior, FallsBackToTheDefault) {
    LatticeTriangle t = affine({0, 0}, {9, 0}, {0, 9});
    const LatticePoint usual = t.p[kInterior];
    t.p[kInterior] = {-90 * kPx, 0};
    ASSERT_FALSE(certified(t));
    EXPECT_EQ(certifiedInterior(t), usual);
}

// Among patches with strongly bent sides there are some that only the linear program saves.
TEST(CertifiedInterior, FindsAPointWhereTheDefaultFails) {
    std::mt19937 random(11);
    int saved = 0, none = 0;
    for (int round = 0; round < 20000; ++round) {
        LatticeTriangle t = randomPatch(random, 5);
        t.p[kInterior] = toLattice(defaultInterior(toPixels(t)));
        if (certified(t)) continue;
        const auto interior = certifiedInterior(t);
        if (!interior) {
            ++none;
            continue;
        }
        ++saved;
        t.p[kInterior] = *interior;
        EXPECT_TRUE(certified(t));
        EXPECT_GT(smallestSample(t, 24), 0);
    }
    EXPECT_GT(saved, 10);
    EXPECT_GT(none, 10);
}

// A patch that was found sound must be so in whatever order its mesh names the corners.
TEST(CertifiedInterior, OfTheDefaultDoesNotDependOnWhichCornerIsFirst) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int32_t> shift(-900, 900);
    int found = 0, none = 0;
    for (int i = 0; i < 3000; ++i) {
        LatticeTriangle t = affine({3, 5}, {11, 6}, {6, 13});
        for (size_t k = 0; k < 9; ++k) t.p[k] = {t.p[k].x + shift(random), t.p[k].y + shift(random)};
        const auto interior = certifiedDefaultInterior(t);
        ++(interior ? found : none);
        for (int turn = 0; turn < 2; ++turn) {
            std::rotate(t.p.begin(), t.p.begin() + 3, t.p.begin() + 9);
            EXPECT_EQ(certifiedDefaultInterior(t), interior) << i;
        }
    }
    EXPECT_GT(found, 100);
    EXPECT_GT(none, 100);
}

TEST(CertifiedInterior, NoneWhereSidesCross) {
    LatticeTriangle t = affine({0, 0}, {9, 0}, {3, 6});
    t.p[1] = {3 * kPx, 12 * kPx};
    t.p[2] = {6 * kPx, 12 * kPx};
    EXPECT_FALSE(certifiedInterior(t).has_value());
    EXPECT_FALSE(certifiedInterior(affine({0, 0}, {0, 9}, {9, 0})).has_value());
}

}  // namespace
}  // namespace tessera
