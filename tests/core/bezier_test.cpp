// Cubic curves and triangles against their definitions.
#include "core/mesh/bezier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/mesh/jacobian.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

constexpr double kTiny = 1e-12;

// A gently curved triangle of size about 1, the same for the same seed.
BezierTriangle randomTriangle(unsigned seed, double bend = .08) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const glm::dvec2 a(0, 0), b(1, .1), c(.3, .9);
    BezierTriangle t;
    for (int i = 0; i <= 3; ++i)
        for (int j = 0; i + j <= 3; ++j) {
            const int k = 3 - i - j;
            t.p[size_t(controlIndex(i, j, k))] = (double(i) * a + double(j) * b + double(k) * c) / 3.0 +
                                                 bend * glm::dvec2(unit(random), unit(random));
        }
    return t;
}

std::vector<Barycentric> latticeOf(int n) {
    std::vector<Barycentric> result;
    for (int j = 0; j <= n; ++j)
        for (int k = 0; j + k <= n; ++k)
            result.push_back({double(n - j - k) / n, double(j) / n, double(k) / n});
    return result;
}

Barycentric mix(const Barycentric& in, const std::array<Barycentric, 3>& corners) {
    return in.x * corners[0] + in.y * corners[1] + in.z * corners[2];
}

void expectSameSurface(const BezierTriangle& part, const BezierTriangle& whole,
                       const std::array<Barycentric, 3>& corners) {
    for (const Barycentric& b : latticeOf(6))
        EXPECT_LT(glm::distance(evaluate(part, b), evaluate(whole, mix(b, corners))), kTiny);
}

const Barycentric kA(1, 0, 0), kB(0, 1, 0), kC(0, 0, 1);

TEST(BezierTriangle, IsThePartitionOfUnityTimesItsControlPoints) {
    const BezierTriangle t = randomTriangle(1);
    const double factorial[] = {1, 1, 2, 6};
    for (const Barycentric& b : latticeOf(7)) {
        glm::dvec2 sum(0);
        double total = 0;
        for (int i = 0; i <= 3; ++i)
            for (int j = 0; i + j <= 3; ++j) {
                const int k = 3 - i - j;
                const double weight = 6 / (factorial[i] * factorial[j] * factorial[k]) * std::pow(b.x, i) *
                                      std::pow(b.y, j) * std::pow(b.z, k);
                sum += weight * t.p[size_t(controlIndex(i, j, k))];
                total += weight;
            }
        EXPECT_NEAR(total, 1, kTiny);
        EXPECT_LT(glm::distance(sum, evaluate(t, b)), kTiny);
    }
}

TEST(BezierTriangle, SidesAreItsRestrictions) {
    const BezierTriangle t = randomTriangle(2);
    const Barycentric corners[] = {kA, kB, kC};
    for (int s = 0; s < 3; ++s)
        for (const double x : {0.0, .2, .5, .9, 1.0})
            EXPECT_LT(glm::distance(BezierCurve{t.side(s)}.at(x),
                                    evaluate(t, (1 - x) * corners[s] + x * corners[(s + 1) % 3])),
                      kTiny);
}

TEST(BezierTriangle, DerivativesMatchDifferences) {
    const BezierTriangle t = randomTriangle(3);
    const double h = 1e-5;
    for (const Barycentric& b : latticeOf(4)) {
        const PatchPoint p = evaluateWithDerivatives(t, b);
        const auto slope = [&](Barycentric direction) {
            return (evaluate(t, b + h * direction) - evaluate(t, b - h * direction)) / (2 * h);
        };
        EXPECT_LT(glm::distance(p.dv, slope({-1, 1, 0})), 1e-8);
        EXPECT_LT(glm::distance(p.dw, slope({-1, 0, 1})), 1e-8);
    }
}

TEST(DeCasteljau, ReproducesTheSurfaceAlsoOutside) {
    const BezierTriangle t = randomTriangle(4);
    for (const Barycentric& at : {Barycentric(1.0 / 3), Barycentric(.5, .5, 0), Barycentric(1, -1, 1)}) {
        const auto parts = deCasteljau(t, at);
        expectSameSurface(parts[0], t, {at, kB, kC});
        expectSameSurface(parts[1], t, {kA, at, kC});
        expectSameSurface(parts[2], t, {kA, kB, at});
    }
}

TEST(Subdivide4, CoversTheSameSurfaceInOrderAndOrientation) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const BezierTriangle t = randomTriangle(seed, .03);
        const auto children = subdivide4(t);
        const Barycentric i = .5 * (kA + kB), j = .5 * (kB + kC), k = .5 * (kC + kA);
        const std::array<Barycentric, 3> corners[] = {{kA, i, k}, {i, kB, j}, {k, j, kC}, {i, j, k}};
        double sum = 0;
        for (size_t c = 0; c < 4; ++c) {
            expectSameSurface(children[c], t, corners[c]);
            EXPECT_GT(signedArea(children[c]), 0);
            sum += signedArea(children[c]);
        }
        EXPECT_NEAR(sum, signedArea(t), kTiny);
    }
}

TEST(SignedArea, MatchesThePolygonOfTheBoundaryAndIsExactOnTheLattice) {
    const PatchMesh mesh = testing::curvedMesh(64, 48, 4, 3, 5);
    int64_t total = 0;
    mesh.forEachPatch([&](PatchId p) {
        const LatticeTriangle lattice = mesh.controlPoints(p);
        const BezierTriangle t = toPixels(lattice);
        constexpr int kSteps = 2000;
        double polygon = 0;
        for (int s = 0; s < 3; ++s) {
            const BezierCurve curve{t.side(s)};
            for (int i = 0; i < kSteps; ++i)
                polygon += .5 * cross(curve.at(double(i) / kSteps), curve.at(double(i + 1) / kSteps));
        }
        EXPECT_NEAR(signedArea(t), polygon, 1e-4);
        const double unit = 20.0 * kLatticePerPixel * kLatticePerPixel;
        EXPECT_NEAR(double(signedArea20(lattice)) / unit, signedArea(t), 1e-9);
        total += signedArea20(lattice);
    });
    EXPECT_EQ(total, int64_t{20} * 64 * 48 * kLatticePerPixel * kLatticePerPixel);
}

TEST(DefaultInterior, HasQuadraticPrecision) {
    // A quadratic map, raised to degree 3 at all points by interpolation of its polar form.
    const auto f = [](const Barycentric& b) {
        return glm::dvec2(b.y + .3 * b.y * b.z - .2 * b.z * b.z, b.z + .1 * b.x * b.y);
    };
    // Points of the cubic on side p -> q by Hermite data of the quadratic along it.
    BezierTriangle t;
    const Barycentric corners[] = {kA, kB, kC};
    for (int s = 0; s < 3; ++s) {
        const Barycentric p = corners[s], q = corners[(s + 1) % 3];
        const glm::dvec2 middle =
            2.0 * f(.5 * (p + q)) - .5 * (f(p) + f(q));  // control point of the quadratic
        t.p[size_t(3 * s)] = f(p);
        t.p[size_t(3 * s + 1)] = (f(p) + 2.0 * middle) / 3.0;
        t.p[size_t(3 * s + 2)] = (f(q) + 2.0 * middle) / 3.0;
    }
    t.p[kInterior] = defaultInterior(t);
    for (const Barycentric& b : latticeOf(5)) EXPECT_LT(glm::distance(evaluate(t, b), f(b)), kTiny);
}

TEST(BezierCurve, PartIsTheSameCurve) {
    const BezierCurve c{{glm::dvec2(0, 0), {1, 2}, {3, -1}, {4, 1}}};
    for (const auto& [t0, t1] :
         {std::pair(0.0, .4), std::pair(.3, .8), std::pair(.9, .1), std::pair(-.2, 1.3)})
        for (const double s : {0.0, .25, .5, 1.0})
            EXPECT_LT(glm::distance(c.part(t0, t1).at(s), c.at(t0 + s * (t1 - t0))), kTiny);
    EXPECT_LT(glm::distance(c.reversed().at(.3), c.at(.7)), kTiny);
}

TEST(BezierCurve, LengthAndDerivative) {
    const BezierCurve line = straightCurve({1, 2}, {4, 6});
    EXPECT_NEAR(line.length(), 5, kTiny);
    const BezierCurve c{{glm::dvec2(0, 0), {1, .5}, {2, .4}, {3, 0}}};
    double chords = 0;
    constexpr int kSteps = 10000;
    for (int i = 0; i < kSteps; ++i)
        chords += glm::distance(c.at(double(i) / kSteps), c.at(double(i + 1) / kSteps));
    EXPECT_NEAR(c.length(), chords, 1e-5);
    const double h = 1e-6;
    EXPECT_LT(glm::distance(c.derivative(.4), (c.at(.4 + h) - c.at(.4 - h)) / (2 * h)), 1e-8);
}

TEST(NearestOnCurve, IsAsNearAsTheNearestOfManySamples) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(-1, 2);
    for (int round = 0; round < 200; ++round) {
        const BezierCurve c{{glm::dvec2(0, 0),
                             {.3 + .2 * unit(random), .2 * unit(random)},
                             {.6 + .2 * unit(random), .2 * unit(random)},
                             {1, 0}}};
        const glm::dvec2 point(unit(random), unit(random));
        const CurveFoot foot = nearestOnCurve(c, point);
        double sampled = 1e9;
        for (int i = 0; i <= 2000; ++i) sampled = std::min(sampled, glm::distance(c.at(i / 2000.0), point));
        EXPECT_LE(foot.distance, sampled + 1e-6);
        EXPECT_NEAR(glm::distance(c.at(foot.t), point), foot.distance, kTiny);
    }
}

TEST(FitCurve, ReproducesACubic) {
    const BezierCurve truth{{glm::dvec2(0, 0), {1, 1}, {2, 1.2}, {3, 0}}};
    std::vector<glm::dvec2> points;
    for (int i = 0; i <= 40; ++i) points.push_back(truth.at(i / 40.0));
    const BezierCurve fit = fitCurve(points, 40);
    EXPECT_LT(maxDistance(fit, points), 1e-4);
    EXPECT_EQ(fit.p[0], points.front());
    EXPECT_EQ(fit.p[3], points.back());
    // More rounds come nearer.
    EXPECT_LT(maxDistance(fitCurve(points, 8), points), maxDistance(fitCurve(points, 0), points));
}

TEST(FitCurve, StraightWhereThereIsNothingElse) {
    const std::vector<glm::dvec2> two{{0, 0}, {3, 3}}, one{{1, 1}, {1, 1}, {1, 1}};
    EXPECT_LT(glm::distance(fitCurve(two).at(.5), {1.5, 1.5}), kTiny);
    EXPECT_EQ(fitCurve(one).at(.5), glm::dvec2(1, 1));
    const std::vector<glm::dvec2> line{{0, 0}, {1, 0}, {2, 0}};
    EXPECT_LT(maxDistance(fitCurve(line), line), 1e-9);
}

}  // namespace
}  // namespace tessera
