// PolynomialFit against least squares by singular values over the pixels one by one.
#include "core/vectorize/polynomial_fit.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <functional>
#include <random>

#include "core/mesh/bezier.h"

namespace tessera {
namespace {

using Corners = std::array<glm::dvec2, 3>;
using Outline = std::vector<glm::dvec2>;

Image paint(int width, int height, int channels, const std::function<double(double, double, int)>& colour) {
    Image image(width, height, channels);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.at(x, y, c) = float(colour(x + .5, y + .5, c));
    return image;
}

// Waves, edges and noise: nothing that a quintic could follow.
Image busy(int width, int height, int channels) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-.1, .1);
    return paint(width, height, channels, [&](double x, double y, int c) {
        return .5 + .3 * std::sin(.4 * x + .1 * c) * std::cos(.3 * y) + (x + 2 * y > 90 ? .2 : 0) +
               noise(random);
    });
}

bool inside(const Outline& outline, glm::dvec2 p) {
    bool in = false;
    for (size_t k = 0; k < outline.size(); ++k) {
        const glm::dvec2 a = outline[k], b = outline[(k + 1) % outline.size()];
        if ((a.x <= p.x) != (b.x <= p.x) && a.y + (b.y - a.y) / (b.x - a.x) * (p.x - a.x) <= p.y) in = !in;
    }
    return in;
}

double leastSquares(const Image& image, const Corners& corners, const Outline& outline) {
    const glm::dvec2 centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    // Barycentric coordinates keep slanted triangles well-posed.
    const glm::dvec2 u = corners[1] - corners[0], v = corners[2] - corners[0];
    const double area = u.x * v.y - u.y * v.x;
    std::vector<glm::ivec2> pixels;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (inside(outline, {x + .5, y + .5})) pixels.emplace_back(x, y);
    if (pixels.empty()) return 0;
    Eigen::MatrixXd terms(Eigen::Index(pixels.size()), PolynomialFit::kTerms);
    Eigen::MatrixXd values(terms.rows(), image.channels());
    for (Eigen::Index i = 0; i < terms.rows(); ++i) {
        const glm::ivec2 q = pixels[size_t(i)];
        const glm::dvec2 d = glm::dvec2(q.x + .5, q.y + .5) - centre;
        const double s = 3 * (d.x * v.y - d.y * v.x) / area, t = 3 * (u.x * d.y - u.y * d.x) / area;
        Eigen::Index k = 0;
        for (int degree = 0; degree <= PolynomialFit::kDegree; ++degree)
            for (int j = 0; j <= degree; ++j) terms(i, k++) = std::pow(s, degree - j) * std::pow(t, j);
        for (int c = 0; c < image.channels(); ++c) values(i, c) = double(image.at(q.x, q.y, c));
    }
    const Eigen::MatrixXd solution = terms.bdcSvd(Eigen::ComputeThinU | Eigen::ComputeThinV).solve(values);
    return (terms * solution - values).squaredNorm();
}

Outline outlineOf(const Corners& c) {
    return {c.begin(), c.end()};
}

// About equilateral, `radius` px from the centre to the corners.
Corners roundTriangle(glm::dvec2 centre, double radius, double angle) {
    Corners c;
    for (size_t k = 0; k < 3; ++k) {
        const double a = angle + 2.0943951 * double(k);
        c[k] = centre + radius * glm::dvec2(std::cos(a), std::sin(a));
    }
    return c;
}

TEST(PolynomialFit, IsLeastSquaresOnWellPosedTriangles) {
    for (const int channels : {3, 4}) {
        const Image image = busy(90, 70, channels);
        const PolynomialFit fit(image);
        std::mt19937 random(1);
        std::uniform_real_distribution<double> unit(0, 1);
        for (int i = 0; i < 100; ++i) {
            const Corners c = roundTriangle({20 + 50 * unit(random), 20 + 30 * unit(random)},
                                            6 + 20 * unit(random), 6 * unit(random));
            const double expected = leastSquares(image, c, outlineOf(c));
            ASSERT_GT(expected, 0);
            EXPECT_NEAR(fit.error(c), expected, 1e-4 * expected) << i;
        }
    }
}

TEST(PolynomialFit, IsLeastSquaresOnThinTriangles) {
    const Image image = busy(120, 100, 3);
    const PolynomialFit fit(image);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 100; ++i) {
        const double angle = 6.3 * unit(random), length = 30 + 15 * unit(random), width = 8;
        const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x), centre(60, 50);
        const Corners c{centre - length * along - width * across, centre + length * along,
                        centre - length * along + width * across};
        const double expected = leastSquares(image, c, outlineOf(c));
        EXPECT_NEAR(fit.error(c), expected, 1e-3 * expected) << i;
    }
}

// Few pixels, on which terms can hardly be told apart.
TEST(PolynomialFit, IsLeastSquaresOnSmallTriangles) {
    const Image image = busy(60, 60, 3);
    const PolynomialFit fit(image);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 300; ++i) {
        Corners c = roundTriangle({0, 0}, 3 + 6 * unit(random), 6 * unit(random));
        const double thin = .2 + .8 * unit(random), angle = 6 * unit(random);
        for (glm::dvec2& p : c) {
            p.y *= thin;
            p = glm::dvec2(30.1, 29.8) + glm::dvec2(std::cos(angle) * p.x - std::sin(angle) * p.y,
                                                    std::sin(angle) * p.x + std::cos(angle) * p.y);
        }
        const double expected = leastSquares(image, c, outlineOf(c));
        EXPECT_NEAR(fit.error(c), expected, 1e-3 * expected + 1e-4) << i;
    }
}

TEST(PolynomialFit, OfCurvedSides) {
    const Image image = busy(90, 70, 3);
    const PolynomialFit fit(image);
    const Corners c{glm::dvec2(12, 50), {75, 55}, {40, 8}};
    for (const double bulge : {-12., -4., 5., 11.}) {
        Outline outline;
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec2 a = c[k], d = c[(k + 1) % 3] - a, normal(-d.y, d.x);
            for (int i = 0; i < 7; ++i) {
                const double t = i / 7.0;
                const double height = (k == 0 ? bulge : -.5 * bulge) / 60;
                outline.push_back(a + t * d + 4 * t * (1 - t) * height * normal);
            }
        }
        const double expected = leastSquares(image, c, outline);
        EXPECT_NEAR(fit.error(c, outline), expected, 1e-4 * expected) << bulge;
        EXPECT_GT(std::abs(fit.error(c) - expected), 1e-2 * expected);
    }
}

// A column that crosses the outline six times.
TEST(PolynomialFit, OfAnOutlineThatIsNotConvex) {
    const Image image = busy(60, 90, 3);
    const PolynomialFit fit(image);
    const Outline comb{{5, 5},   {50, 5},  {50, 20}, {20, 22}, {50, 35},
                       {50, 50}, {20, 52}, {50, 60}, {50, 80}, {5, 80}};
    const Corners c{glm::dvec2(5, 5), {55, 40}, {5, 80}};
    const double expected = leastSquares(image, c, comb);
    EXPECT_NEAR(fit.error(c, comb), expected, 1e-4 * expected);
}

TEST(PolynomialFit, IsZeroForQuinticsAndNotForSextics) {
    const auto polynomial = [](int degree) {
        return [degree](double x, double y, int c) {
            const double u = (x - 45) / 20, v = (y - 35) / 20;
            return .3 + .2 * std::pow(.8 * u + .5 * v, degree) - .1 * c * std::pow(u - .6 * v, degree) +
                   .1 * u * v;
        };
    };
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int degree = 0; degree <= 6; ++degree) {
        const Image image = paint(90, 70, 4, polynomial(degree));
        const PolynomialFit fit(image);
        for (int i = 0; i < 20; ++i) {
            const Corners c = roundTriangle({40 + 10 * unit(random), 30 + 10 * unit(random)},
                                            20 + 5 * unit(random), 6 * unit(random));
            if (degree <= PolynomialFit::kDegree)
                EXPECT_LT(fit.error(c), 1e-4) << degree;
            else
                EXPECT_GT(fit.error(c), 1e-3);
        }
    }
}

TEST(PolynomialFit, MovesWithThePicture) {
    const Image image = busy(90, 70, 3);
    constexpr int kRight = 13, kDown = 5;
    Image moved(130, 90, 3, .25f);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 70; ++y)
            for (int x = 0; x < 90; ++x) moved.at(x + kRight, y + kDown, c) = image.at(x, y, c);
    const PolynomialFit fit(image), other(moved);
    for (double angle = 0; angle < 6; angle += .7) {
        const Corners c = roundTriangle({45, 35}, 25, angle);
        Corners d = c;
        for (glm::dvec2& p : d) p += glm::dvec2(kRight, kDown);
        EXPECT_NEAR(other.error(d), fit.error(c), 1e-4 * fit.error(c));
    }
}

TEST(PolynomialFit, IsZeroWithoutPixels) {
    const PolynomialFit fit(busy(40, 40, 3));
    EXPECT_EQ(fit.error({glm::dvec2(10.6, 10.6), {11.4, 10.6}, {11, 11.4}}), 0);  // between centres
    EXPECT_EQ(fit.error({glm::dvec2(-30, 5), {-10, 5}, {-20, 25}}), 0);           // outside
    EXPECT_EQ(fit.error({glm::dvec2(45, 5), {65, 5}, {50, 25}}), 0);
    EXPECT_EQ(fit.error({glm::dvec2(5, 5), {5, 5}, {5, 5}}), 0);
    EXPECT_EQ(fit.error({glm::dvec2(3, 7), {20, 7}, {35, 7}}), 0);  // without area
}

// No more pixels than a polynomial passes through.
TEST(PolynomialFit, IsNothingMuchOnTinyTriangles) {
    const Image image = busy(40, 40, 3);
    const PolynomialFit fit(image);
    for (double angle = 0; angle < 6; angle += .3) {
        const Corners c = roundTriangle({20.3, 19.8}, 1.4, angle);
        EXPECT_LT(fit.error(c), 1e-5);
        EXPECT_GE(fit.error(c), 0);
    }
    // A row of ten pixels, through which a quintic does not pass.
    const Corners row{glm::dvec2(8, 20.3), {22, 20.1}, {22, 20.9}};
    EXPECT_GT(fit.error(row), 1e-4);
}

TEST(PolynomialFit, CutsWhatReachesBeyondThePicture) {
    for (const int width : {1, 7, 8, 9, 40}) {
        const Image image = busy(width, 40, 3);
        const Corners c{glm::dvec2(-30, -10), {70, 15}, {-20, 55}};
        const double expected = leastSquares(image, c, outlineOf(c));
        if (width == 1) {
            EXPECT_GT(PolynomialFit(image).error(c), 0);
            continue;
        }
        EXPECT_NEAR(PolynomialFit(image).error(c), expected, 1e-3 * expected) << width;
    }
}

TEST(PolynomialFit, OfOnePixel) {
    for (const int channels : {3, 4}) {
        const PolynomialFit fit(Image(1, 1, channels, .7f));
        EXPECT_NEAR(fit.error({glm::dvec2(0, 0), {1, 0}, {0, 1.2}}), 0, 1e-9);
        EXPECT_NEAR(fit.error({glm::dvec2(-5, -5), {9, 0}, {0, 9}}), 0, 1e-9);
    }
}

// Long sums stay exact: columns are longer than what is summed as floats.
TEST(PolynomialFit, OfLargeTriangles) {
    const Image image = busy(300, 500, 3);
    const Corners c{glm::dvec2(-10, 490), {310, 480}, {140, 3}};
    const double expected = leastSquares(image, c, outlineOf(c));
    EXPECT_NEAR(PolynomialFit(image).error(c), expected, 1e-5 * expected);
}

}  // namespace
}  // namespace tessera
