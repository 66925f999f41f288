// See tps.h.
#include "core/mesh/tps.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/base/check.h"

namespace tessera {

double tpsKernel(double squaredDistance) {
    return squaredDistance > 0 ? .5 * squaredDistance * std::log(squaredDistance) : 0;
}

const std::array<glm::dvec2, kDefaultCentreCount>& defaultCentres() {
    static const auto centres = [] {
        const auto third = [](double i, double j, double k) {
            return domainPoint(Barycentric(i / 3, j / 3, k / 3));
        };
        const double s = 1.0 / 3;
        return std::array<glm::dvec2, kDefaultCentreCount>{
            third(3, 0, 0),     third(0, 3, 0),         third(0, 0, 3),         third(2, 1, 0),
            third(1, 2, 0),     third(0, 2, 1),         third(0, 1, 2),         third(1, 0, 2),
            third(2, 0, 1),     third(1, 1, 1),         third(2 + s, s, s),     third(s, 2 + s, s),
            third(s, s, 2 + s), third(1 + s, 1 + s, s), third(s, 1 + s, 1 + s), third(1 + s, s, 1 + s)};
    }();
    return centres;
}

namespace {

// In 24ths of the domain. After the first seven, each is the point of the lattice where the splines of those
// before it err most (the largest power function); but one on a side brings its mirror images on all sides
// with it, so that two patches have the same centres along their common edge.
constexpr std::array<std::array<uint8_t, 3>, kNestedCentreCount> kNestedIn24ths{
    {{24, 0, 0},  {0, 24, 0},  {0, 0, 24}, {12, 12, 0}, {0, 12, 12}, {12, 0, 12}, {8, 8, 8},  {18, 6, 0},
     {0, 6, 18},  {6, 18, 0},  {18, 0, 6}, {6, 0, 18},  {0, 18, 6},  {13, 6, 5},  {6, 13, 5}, {5, 5, 14},
     {10, 4, 10}, {4, 10, 10}, {20, 2, 2}, {2, 20, 2},  {2, 2, 20},  {15, 0, 9},  {0, 15, 9}, {15, 9, 0},
     {0, 9, 15},  {9, 0, 15},  {9, 15, 0}, {10, 10, 4}, {16, 3, 5},  {3, 16, 5},  {3, 0, 21}, {3, 21, 0},
     {21, 3, 0},  {0, 3, 21},  {21, 0, 3}, {0, 21, 3},  {13, 3, 8},  {3, 13, 8},  {8, 3, 13}, {3, 8, 13},
     {4, 3, 17},  {6, 7, 11},  {6, 16, 2}, {16, 6, 2},  {9, 13, 2},  {13, 9, 2},  {6, 11, 7}, {2, 6, 16}}};

}  // namespace

const std::array<glm::dvec2, kNestedCentreCount>& nestedCentres() {
    static const auto centres = [] {
        std::array<glm::dvec2, kNestedCentreCount> all{};
        for (size_t i = 0; i < all.size(); ++i) {
            const auto& c = kNestedIn24ths[i];
            all[i] = domainPoint(Barycentric(c[0] / 24.0, c[1] / 24.0, c[2] / 24.0));
        }
        return all;
    }();
    return centres;
}

std::span<const glm::dvec2> centresOf(CentreLayout layout) {
    if (layout == CentreLayout::Nested) return nestedCentres();
    return defaultCentres();
}

size_t PatchSpline::offset(int c) const {
    size_t sum = 0;
    for (int i = 0; i < c; ++i) sum += 3u + terms[size_t(i)];
    return sum;
}

int PatchSpline::maxTerms(int channels) const {
    return *std::max_element(terms.begin(), terms.begin() + channels);
}

PatchSpline constantSpline(std::span<const float> colour) {
    TESSERA_CHECK(colour.size() <= kMaxChannels);
    PatchSpline spline;
    for (const float value : colour) spline.coefficients.insert(spline.coefficients.end(), {value, 0, 0});
    return spline;
}

double evaluateSpline(const PatchSpline& spline, int c, glm::dvec2 at) {
    const float* k = spline.coefficients.data() + spline.offset(c);
    double sum = double(k[0]) + double(k[1]) * at.x + double(k[2]) * at.y;
    for (int i = 0; i < spline.terms[size_t(c)]; ++i) {
        const glm::dvec2 d = at - spline.centre(i);
        sum += double(k[3 + i]) * tpsKernel(d.x * d.x + d.y * d.y);
    }
    return sum;
}

NodalBasis nodalBasis(std::span<const glm::dvec2> centres) {
    const auto n = Eigen::Index(centres.size());
    TESSERA_CHECK(n >= 3);
    // Eq. 4: [K P; P^T 0] (alpha, b) = (h, 0).
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 3, n + 3);
    for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = 0; j < n; ++j) {
            const glm::dvec2 d = centres[size_t(i)] - centres[size_t(j)];
            system(i, j) = tpsKernel(d.x * d.x + d.y * d.y);
        }
        system(i, n) = system(n, i) = 1;
        system(i, n + 1) = system(n + 1, i) = centres[size_t(i)].x;
        system(i, n + 2) = system(n + 2, i) = centres[size_t(i)].y;
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(system);
    TESSERA_CHECK(lu.isInvertible());
    const Eigen::MatrixXd inverse = lu.inverse();
    NodalBasis basis;
    basis.n = int(n);
    basis.toCoefficients.resize(size_t((n + 3) * n));
    for (Eigen::Index r = 0; r < n + 3; ++r)
        for (Eigen::Index c = 0; c < n; ++c)
            basis.toCoefficients[size_t(r * n + c)] = inverse(r < 3 ? n + r : r - 3, c);
    return basis;
}

const NodalBasis& defaultNodalBasis() {
    static const NodalBasis basis = nodalBasis(defaultCentres());
    return basis;
}

const NodalBasis& nestedNodalBasis(int n) {
    TESSERA_CHECK(n >= 3 && n <= kNestedCentreCount);
    struct Entry {
        std::once_flag once;
        NodalBasis basis;
    };
    static std::array<Entry, kNestedCentreCount + 1> entries;
    Entry& entry = entries[size_t(n)];
    std::call_once(entry.once,
                   [&] { entry.basis = nodalBasis(std::span(nestedCentres()).first(size_t(n))); });
    return entry.basis;
}

}  // namespace tessera
