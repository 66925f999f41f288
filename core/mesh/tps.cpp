// See tps.h.
#include "core/mesh/tps.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

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

const std::array<glm::dvec2, kCentreSites>& centreSites() {
    static const auto sites = [] {
        std::array<glm::dvec2, kCentreSites> all{};
        constexpr int n = kSiteSubdivisions;
        const auto point = [](int i, int j) {
            return domainPoint(Barycentric(double(n - i - j) / n, double(i) / n, double(j) / n));
        };
        all[0] = point(0, 0);
        all[1] = point(n, 0);
        all[2] = point(0, n);
        size_t count = 3;
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i + j <= n; ++i)
                if (i < n && j < n && i + j > 0) all[count++] = point(i, j);
        return all;
    }();
    return sites;
}

glm::dvec2 PatchSpline::centre(int i) const {
    if (!sites.empty()) return centreSites()[sites[size_t(i)]];
    return centres.empty() ? defaultCentres()[size_t(i)] : glm::dvec2(centres[size_t(i)]);
}

size_t PatchSpline::centreCount() const {
    if (!sites.empty()) return sites.size();
    return centres.empty() ? defaultCentres().size() : centres.size();
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

glm::dvec2 splineGradient(const PatchSpline& spline, int c, glm::dvec2 at) {
    const float* k = spline.coefficients.data() + spline.offset(c);
    glm::dvec2 sum{double(k[1]), double(k[2])};
    for (int i = 0; i < spline.terms[size_t(c)]; ++i) {
        const glm::dvec2 d = at - spline.centre(i);
        const double q = d.x * d.x + d.y * d.y;
        // phi = q log(q) / 2, so grad phi = (log q + 1) d.
        if (q > 0) sum += double(k[3 + i]) * (std::log(q) + 1) * d;
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

}  // namespace tessera
