// Thin-plate splines: the kernel, interpolation, and the vector code against the readable one.
#include "core/mesh/tps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

// The kernel as `instructions` compute it: one channel, one centre at the corner, alpha 1. (The side
// conditions do not matter to evaluation.)
double largestKernelError(SplineInstructions instructions) {
    PatchSpline spline;
    spline.terms = {1, 0, 0, 0};
    spline.coefficients = {0, 0, 0, 1};
    spline.centres = {{0, 0}};
    // Every float from 2^-24 to 1 in steps of 5 units in the last place, and all powers of two below.
    std::vector<float> x{0};
    for (uint32_t bits = 1; bits < 0x33800000; bits += 0x00400000) x.push_back(std::bit_cast<float>(bits));
    for (uint32_t bits = 0x33800000; bits <= 0x3f800000; bits += 5) x.push_back(std::bit_cast<float>(bits));
    const std::vector<float> y(x.size(), 0);
    std::vector<float> value(x.size());
    float* out[] = {value.data()};
    evaluateSplinesWith(instructions, spline, 1, x.data(), y.data(), x.size(), out);
    double worst = 0;
    for (size_t i = 0; i < x.size(); ++i)
        worst = std::max(worst, std::abs(double(value[i]) - tpsKernel(double(x[i]) * double(x[i]))));
    return worst;
}

TEST(TpsKernel, Definition) {
    EXPECT_EQ(tpsKernel(0), 0);
    EXPECT_EQ(tpsKernel(1), 0);
    EXPECT_NEAR(tpsKernel(.25), .25 * std::log(.5), 1e-15);
}

TEST(EvaluateSplines, KernelIsWithinAMillionth) {
    for (const SplineInstructions instructions : splineInstructions())
        EXPECT_LT(largestKernelError(instructions), 1e-6) << nameOf(instructions);
}

TEST(EvaluateSplines, AgreesWithTheReadableTwin) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0, 1);
    double worst = 0;
    for (int round = 0; round < 200; ++round) {
        const int channels = 1 + round % 4;
        PatchSpline spline = testing::randomSpline(channels, random);
        if (round % 3 == 0) {  // Other terms: a prefix of the centres, no alphas at all, centres of its own.
            const std::vector<float> all = spline.coefficients;
            spline.coefficients.clear();
            for (int c = 0; c < channels; ++c) {
                const int n = c % 2 == 0 ? 5 + c : 0;
                const auto from = all.begin() + c * 19;
                spline.coefficients.insert(spline.coefficients.end(), from, from + 3 + n);
                spline.terms[size_t(c)] = uint8_t(n);
            }
            if (round % 2 == 0)
                for (int i = 0; i < 9; ++i)
                    spline.centres.push_back({.1f + .08f * float(i), .05f * float(i)});
        }
        const size_t count = size_t(round);  // every remainder of the vector length
        std::vector<float> x(count), y(count);
        for (size_t i = 0; i < count; ++i) {
            const float s = unit(random), t = unit(random) * (1 - s);
            x[i] = s + .5f * t;
            y[i] = float(kDomainHeight) * t;
        }
        if (count > 0) x[0] = y[0] = 0;  // on a centre
        std::map<SplineInstructions, std::vector<std::vector<float>>> results;
        for (const SplineInstructions instructions : splineInstructions()) {
            SCOPED_TRACE(nameOf(instructions));
            auto& values = results[instructions];
            values.assign(4, std::vector<float>(count + 1, -7));
            float* out[] = {values[0].data(), values[1].data(), values[2].data(), values[3].data()};
            evaluateSplinesWith(instructions, spline, channels, x.data(), y.data(), count, out);
            for (int c = 0; c < channels; ++c) {
                for (size_t i = 0; i < count; ++i)
                    worst = std::max(worst,
                                     std::abs(double(out[c][i]) - evaluateSpline(spline, c, {x[i], y[i]})));
                EXPECT_EQ(out[c][count], -7) << "wrote beyond the last point";
            }
        }
        if (results.contains(SplineInstructions::Avx512)) {
            EXPECT_EQ(results[SplineInstructions::Avx512], results[SplineInstructions::Avx2]);
        }
    }
    EXPECT_LT(worst, 1e-5);
    RecordProperty("worst", std::to_string(worst));
}

TEST(EvaluateSplines, APointDoesNotDependOnItsNeighbours) {
    std::mt19937 random(3);
    const PatchSpline spline = testing::randomSpline(3, random);
    std::vector<float> x(37), y(37);
    for (size_t i = 0; i < x.size(); ++i) {
        x[i] = .02f * float(i);
        y[i] = .01f * float(i);
    }
    std::vector<float> together(3 * 37);
    float* out[] = {together.data(), together.data() + 37, together.data() + 74};
    for (const SplineInstructions instructions : splineInstructions()) {
        SCOPED_TRACE(nameOf(instructions));
        evaluateSplinesWith(instructions, spline, 3, x.data(), y.data(), 37, out);
        for (size_t i = 0; i < 37; ++i) {
            float alone[3];
            float* aloneOut[] = {alone, alone + 1, alone + 2};
            evaluateSplinesWith(instructions, spline, 3, &x[i], &y[i], 1, aloneOut);
            for (size_t c = 0; c < 3; ++c) EXPECT_EQ(alone[c], together[37 * c + i]);
        }
    }
}

TEST(DefaultCentres, AreSixteenWithNineOnTheBoundary) {
    const auto& centres = defaultCentres();
    int boundary = 0;
    for (size_t i = 0; i < centres.size(); ++i) {
        const Barycentric b = barycentricOf(centres[i]);
        const double least = std::min({b.x, b.y, b.z});
        EXPECT_GE(least, -1e-12);
        boundary += least < 1e-12;
        for (size_t j = 0; j < i; ++j) {
            const glm::dvec2 d = centres[i] - centres[j];
            EXPECT_GT(d.x * d.x + d.y * d.y, .01);
        }
    }
    EXPECT_EQ(boundary, 9);
    EXPECT_EQ(centres[0], domainPoint({1, 0, 0}));
    EXPECT_EQ(centres[1], domainPoint({0, 1, 0}));
    EXPECT_EQ(centres[2], domainPoint({0, 0, 1}));
}

TEST(NodalBasis, InterpolatesAndFulfilsTheSideConditions) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const int n : {3, 7, 16}) {
        const auto& all = defaultCentres();
        const std::vector<glm::dvec2> centres(all.begin(), all.begin() + n);
        const NodalBasis basis = nodalBasis(centres);
        std::vector<double> nodal(static_cast<size_t>(n));
        for (double& v : nodal) v = unit(random);
        std::vector<double> k(size_t(n + 3), 0);
        for (int r = 0; r < n + 3; ++r)
            for (int i = 0; i < n; ++i)
                k[size_t(r)] += basis.toCoefficients[size_t(r * n + i)] * nodal[size_t(i)];
        double sum = 0;
        glm::dvec2 moment(0);
        for (size_t i = 0; i < size_t(n); ++i) {
            sum += k[3 + i];
            moment += k[3 + i] * centres[i];
        }
        EXPECT_NEAR(sum, 0, 1e-10);
        EXPECT_NEAR(moment.x, 0, 1e-10);
        EXPECT_NEAR(moment.y, 0, 1e-10);
        for (size_t i = 0; i < size_t(n); ++i) {
            double value = k[0] + k[1] * centres[i].x + k[2] * centres[i].y;
            for (size_t j = 0; j < size_t(n); ++j) {
                const glm::dvec2 d = centres[i] - centres[j];
                value += k[3 + j] * tpsKernel(d.x * d.x + d.y * d.y);
            }
            EXPECT_NEAR(value, nodal[i], 1e-10);
        }
    }
}

TEST(PatchSpline, OffsetsFollowTheTerms) {
    PatchSpline spline;
    spline.terms = {16, 0, 5, 3};
    EXPECT_EQ(spline.offset(0), 0u);
    EXPECT_EQ(spline.offset(1), 19u);
    EXPECT_EQ(spline.offset(2), 22u);
    EXPECT_EQ(spline.offset(3), 30u);
    EXPECT_EQ(spline.maxTerms(3), 16);
    const std::array<float, 3> colour{.1f, .2f, .3f};
    const PatchSpline flat = constantSpline(colour);
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(float(evaluateSpline(flat, c, {.4, .3})), colour[size_t(c)]);
}

}  // namespace
}  // namespace tessera
