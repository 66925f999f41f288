// See spline_edit.h.
#include "core/edit/spline_edit.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>

#include "core/base/check.h"
#include "core/mesh/newton_basis.h"

namespace tessera {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPolynomials = 3;
constexpr int kCorners = 3;

// Shares of channels in channels, row by channel that is made; the last column is a constant.
using Mix = std::array<std::array<double, kMaxChannels + 1>, kMaxChannels>;

Mix mixOf(int channels, ColourBasis basis, const AffineColour& change) {
    constexpr double kThird = .57735026918962576451, kHalf = .70710678118654752440,
                     kSixth = .40824829046386301637;
    // Rows: the basis' channels from R, G, B. glm fills columns.
    const glm::dmat3 toBasis = basis == ColourBasis::Rgb ? glm::dmat3(1)
                                                         : glm::dmat3(kThird, kHalf, kSixth, kThird, 0,
                                                                      -2 * kSixth, kThird, -kHalf, kSixth);
    const glm::dmat3 matrix = toBasis * change.matrix * glm::transpose(toBasis);
    const glm::dvec3 offset = toBasis * change.offset;
    Mix mix{};
    // Shares that are rounding would give a channel terms that it does not need.
    constexpr double kNothing = 1e-9;
    const auto share = [&](double value) { return std::abs(value) < kNothing ? 0 : value; };
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            mix[size_t(row)][size_t(column)] = share(matrix[column][row]);
        // Premultiplied: a constant is so much of alpha.
        mix[size_t(row)][channels == 4 ? 3 : kMaxChannels] = share(offset[row]);
    }
    mix[3][3] = 1;
    return mix;
}

}  // namespace

AffineColour tinted(glm::dvec3 colour, double strength) {
    constexpr glm::dvec3 kLuma(.2126, .7152, .0722);
    AffineColour tint;
    // colour + (luma of the old - luma of the colour), in each channel.
    const glm::dmat3 luma(glm::dvec3(kLuma.x), glm::dvec3(kLuma.y), glm::dvec3(kLuma.z));
    tint.matrix = (1 - strength) * glm::dmat3(1) + strength * luma;
    tint.offset = strength * (colour - glm::dvec3(glm::dot(kLuma, colour)));
    return tint;
}

PatchSpline mixed(const PatchSpline& spline, int channels, ColourBasis basis, const AffineColour& change) {
    const Mix mix = mixOf(channels, basis, change);
    const auto count = size_t(channels);
    PatchSpline result;
    result.sites = spline.sites;
    result.centres = spline.centres;
    std::array<size_t, kMaxChannels> lengths{};
    for (size_t c = 0; c < count; ++c) {
        for (size_t from = 0; from < count; ++from)
            if (mix[c][from] != 0) result.terms[c] = std::max(result.terms[c], spline.terms[from]);
        lengths[c] = size_t(kPolynomials) + result.terms[c];
    }
    result.coefficients.resize(std::accumulate(lengths.begin(), lengths.end(), size_t{0}));
    float* out = result.coefficients.data();
    std::array<double, kPolynomials + 255> sum;
    for (size_t c = 0; c < count; ++c) {
        std::fill_n(sum.begin(), lengths[c], 0.0);
        sum[0] = mix[c][kMaxChannels];
        const float* k = spline.coefficients.data();
        for (size_t from = 0; from < count; ++from) {
            const size_t own = size_t(kPolynomials) + spline.terms[from];
            const double share = mix[c][from];
            if (share != 0)
                for (size_t i = 0; i < own; ++i) sum[i] += share * double(k[i]);
            k += own;
        }
        out = std::transform(sum.begin(), sum.begin() + long(lengths[c]), out,
                             [](double v) { return float(v); });
    }
    return result;
}

namespace {

// A basis of functions at the points, with its normal equations.
struct Factorized {
    MatrixXd functions;  // points x functions
    MatrixXd weighted;
    Eigen::LLT<MatrixXd> normal;

    Factorized(MatrixXd values, const RefitPoints& at) : functions(std::move(values)) {
        weighted = Eigen::Map<const VectorXd>(at.weights.data(), functions.rows()).asDiagonal() * functions;
        MatrixXd gram = functions.transpose() * weighted;
        gram.diagonal().array() += 1e-9;  // sites may be as many as points
        normal.compute(gram);
    }
    MatrixXd solve(const MatrixXd& targets) const { return normal.solve(weighted.transpose() * targets); }
};

MatrixXd newtonFunctions(const NewtonBasis& basis, const RefitPoints& at) {
    Eigen::MatrixXf values(Eigen::Index(at.size()), basis.size());
    basis.evaluate(at.domain.x.data(), at.domain.y.data(), at.size(), values.data(), at.size());
    return values.cast<double>();
}

// The 16 default centres at all points: functions are 1 at one centre and 0 at the others.
const Factorized& defaultFactorized() {
    static const Factorized factorized = [] {
        constexpr Eigen::Index n = kDefaultCentreCount;
        MatrixXd raw(kCentreSites, n + kPolynomials);
        for (Eigen::Index i = 0; i < kCentreSites; ++i) {
            const glm::dvec2 at = centreSites()[size_t(i)];
            raw.row(i).head<kPolynomials>() << 1, at.x, at.y;
            for (Eigen::Index k = 0; k < n; ++k) {
                const glm::dvec2 d = at - defaultCentres()[size_t(k)];
                raw(i, kPolynomials + k) = tpsKernel(d.x * d.x + d.y * d.y);
            }
        }
        const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> nodal(
            defaultNodalBasis().toCoefficients.data(), n + kPolynomials, n);
        return Factorized(raw * nodal, RefitPoints::all());
    }();
    return factorized;
}

PatchSpline defaultSpline(const MatrixXd& nodalValues) {
    const NodalBasis& basis = defaultNodalBasis();
    const auto n = size_t(basis.n);
    PatchSpline spline;
    for (Eigen::Index c = 0; c < nodalValues.cols(); ++c) {
        spline.terms[size_t(c)] = uint8_t(n);
        for (size_t row = 0; row < n + kPolynomials; ++row) {
            double sum = 0;
            for (size_t k = 0; k < n; ++k)
                sum += basis.toCoefficients[row * n + k] * nodalValues(Eigen::Index(k), c);
            spline.coefficients.push_back(float(sum));
        }
    }
    return spline;
}

// Factors too small to be seen are left out from the end of each channel.
PatchSpline newtonSpline(const NewtonBasis& basis, const MatrixXd& factors) {
    constexpr double kUnseen = .02 / 255;
    std::vector<std::span<const double>> channels;
    Eigen::Index most = kCorners;
    for (Eigen::Index c = 0; c < factors.cols(); ++c) {
        Eigen::Index n = factors.rows();
        while (n > kCorners && std::abs(factors(n - 1, c)) < kUnseen) --n;
        channels.emplace_back(factors.col(c).data(), size_t(n));
        most = std::max(most, n);
    }
    PatchSpline spline = basis.spline(channels);
    spline.sites.resize(most > kCorners ? size_t(most) : 0);
    return spline;
}

// Further sites, where `left` (points x channels, the points are the sites) is largest.
void addSites(const MatrixXd& left, std::vector<uint8_t>& sites) {
    constexpr int kAtOnce = 6;
    VectorXd size = left.rowwise().squaredNorm();
    for (const uint8_t s : sites) size(s) = -1;
    for (int i = 0; i < kAtOnce; ++i) {
        Eigen::Index worst = 0;
        if (size.maxCoeff(&worst) < 0) return;
        sites.push_back(uint8_t(worst));
        size(worst) = -1;
    }
}

}  // namespace

std::optional<PlacedChange> PlacedChange::nearest(const AffineColour& guess, const RefitPoints& points,
                                                  std::span<const glm::dvec3> colours,
                                                  std::span<const glm::dvec3> targets, double mean,
                                                  double most) {
    const std::vector<Barycentric>& at = points.barycentrics;
    glm::dvec3 middle(0);
    for (const glm::dvec3& c : colours) middle += c / double(colours.size());
    // What is left of the guess, as a linear function of a colour's difference from the middle and of place.
    using Row = Eigen::Matrix<double, 6, 1>;
    const auto rowOf = [&](size_t i) {
        const glm::dvec3 off = colours[i] - middle;
        return Row(off.x, off.y, off.z, at[i].x, at[i].y, at[i].z);
    };
    // Where a patch has no colours to tell from, the guess stays.
    constexpr double kRidge = 1e-4;
    Eigen::Matrix<double, 6, 6> normal = Row(kRidge, kRidge, kRidge, 0, 0, 0).asDiagonal();
    Eigen::Matrix<double, 6, 3> right = Eigen::Matrix<double, 6, 3>::Zero();
    for (size_t i = 0; i < colours.size(); ++i) {
        const Row row = rowOf(i);
        const Row weighted = points.weights[i] * row;
        const glm::dvec3 left = targets[i] - guess(colours[i]);
        normal.noalias() += weighted * row.transpose();
        for (int c = 0; c < 3; ++c) right.col(c) += left[c] * weighted;
    }
    const Eigen::Matrix<double, 6, 3> found = normal.llt().solve(right);
    PlacedChange result{guess, {}};
    for (int c = 0; c < 3; ++c) {
        for (int from = 0; from < 3; ++from) result.change.matrix[from][c] += found(from, c);
        for (int corner = 0; corner < 3; ++corner)
            result.corners[size_t(c)][size_t(corner)] = float(found(3 + corner, c));
    }
    result.change.offset -= (result.change.matrix - guess.matrix) * middle;
    double sum = 0;
    for (size_t i = 0; i < colours.size(); ++i) {
        glm::dvec3 off = result.change(colours[i]) - targets[i];
        for (int c = 0; c < 3; ++c) {
            for (int corner = 0; corner < 3; ++corner) off[c] += at[i][corner] * found(3 + corner, c);
            if (!(std::abs(off[c]) <= most)) return std::nullopt;
            sum += std::abs(off[c]);
        }
    }
    if (sum > mean * 3 * double(colours.size())) return std::nullopt;
    return result;
}

std::vector<uint8_t> usualSites() {
    std::vector<uint8_t> sites;
    for (const glm::dvec2 c : defaultCentres()) {
        const auto& all = centreSites();
        const auto nearest = std::min_element(all.begin(), all.end(), [&](glm::dvec2 a, glm::dvec2 b) {
            const glm::dvec2 da = a - c, db = b - c;
            return da.x * da.x + da.y * da.y < db.x * db.x + db.y * db.y;
        });
        const auto site = uint8_t(nearest - all.begin());
        if (std::find(sites.begin(), sites.end(), site) == sites.end()) sites.push_back(site);
    }
    return sites;
}

RefitPoints::RefitPoints(std::vector<uint8_t> places) : sites(std::move(places)) {
    constexpr double kOnSide = 4;
    for (const uint8_t s : sites) {
        const Barycentric b = barycentricOf(centreSites()[s]);
        barycentrics.push_back(b);
        weights.push_back(std::min({b.x, b.y, b.z}) < 1e-9 ? kOnSide : 1);
    }
    domain = DomainPoints(barycentrics);
}

const RefitPoints& RefitPoints::all() {
    static const RefitPoints points([] {
        std::vector<uint8_t> sites(kCentreSites);
        std::iota(sites.begin(), sites.end(), uint8_t{0});
        return sites;
    }());
    return points;
}

RefitPoints RefitPoints::enoughFor(const PatchSpline& spline) {
    constexpr size_t kFew = 48;
    // Splines on the default centres share a factorization at all points.
    const bool shared = spline.sites.empty() && spline.maxTerms(kMaxChannels) > 0;
    if (shared || spline.sites.size() > kFew) return all();
    static const std::vector<uint8_t> everyOther = [] {
        std::vector<uint8_t> sites;
        const auto odd = [](double share) { return std::lround(share * kSiteSubdivisions) % 2 != 0; };
        for (const uint8_t s : all().sites)
            if (const Barycentric& b = all().barycentrics[s]; !odd(b.y) && !odd(b.z)) sites.push_back(s);
        return sites;
    }();
    std::vector<uint8_t> sites = everyOther;
    for (const uint8_t s : spline.sites)
        if (!std::binary_search(everyOther.begin(), everyOther.end(), s)) sites.push_back(s);
    return RefitPoints(std::move(sites));
}

struct SplineRefit::System {
    const RefitPoints& at;
    std::vector<uint8_t> sites;  // empty: the default centres
    std::unique_ptr<const NewtonBasis> basis;
    std::unique_ptr<const Factorized> own;

    System(std::vector<uint8_t> places, const RefitPoints& points) : at(points), sites(std::move(places)) {
        if (sites.empty()) return;
        basis = std::make_unique<NewtonBasis>(sites);
        own = std::make_unique<Factorized>(newtonFunctions(*basis, at), at);
    }
    const Factorized& factorized() const { return own ? *own : defaultFactorized(); }
};

SplineRefit::SplineRefit(const PatchSpline& like, const RefitPoints& at) {
    std::vector<uint8_t> sites = like.sites;
    const bool usual = sites.empty() && like.centres.empty() &&
                       std::any_of(like.terms.begin(), like.terms.end(), [](uint8_t n) { return n > 0; });
    TESSERA_CHECK(!usual || at.size() == size_t(kCentreSites));
    if (sites.empty() && !usual) sites = {0, 1, 2};
    mSystem = std::make_unique<System>(std::move(sites), at);
}
SplineRefit::~SplineRefit() = default;
SplineRefit::SplineRefit(SplineRefit&&) noexcept = default;
SplineRefit& SplineRefit::operator=(SplineRefit&&) noexcept = default;

std::optional<PatchSpline> SplineRefit::fit(std::span<const double> values, int channels) const {
    const RefitPoints& at = mSystem->at;
    const Eigen::Map<const MatrixXd> targets(values.data(), Eigen::Index(at.size()), channels);
    const auto deviation = [&](const MatrixXd& left) { return left.cwiseAbs().mean(); };
    const Factorized& first = mSystem->factorized();
    MatrixXd factors = first.solve(targets);
    MatrixXd left = targets - first.functions * factors;
    if (deviation(left) <= kRefitTolerance)
        return mSystem->basis ? newtonSpline(*mSystem->basis, factors) : defaultSpline(factors);
    if (at.size() < size_t(kCentreSites)) return std::nullopt;

    std::vector<uint8_t> sites = mSystem->basis ? mSystem->sites : usualSites();
    for (;;) {
        addSites(left, sites);
        const NewtonBasis basis(sites);
        const Factorized more(newtonFunctions(basis, at), at);
        factors = more.solve(targets);
        left = targets - more.functions * factors;
        if (deviation(left) <= kRefitTolerance || sites.size() == kCentreSites)
            return newtonSpline(basis, factors);
    }
}

}  // namespace tessera
