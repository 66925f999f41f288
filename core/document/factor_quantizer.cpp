// The rounding of splines on sites to factors; see factor_codec.h.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/row_products.h"
#include "core/document/factor_codec.h"
#include "core/document/site_norms.h"

namespace tessera {

namespace {

constexpr uint8_t kCorners = 3;
// The trapezoidal rule on the lattice makes the functions larger than they are; measured.
constexpr double kTrueShare = .93;
constexpr double kLeastArea = 1.0 / 16, kLargestArea = 16;

// Whether the spline is what its values at the sites make it: its side conditions hold up to what the floats
// leave, or what they are off changes less than rounding does.
bool keepsSideConditions(const PatchSpline& spline, int c, double tolerance) {
    constexpr double kLargestPhi = .1840;
    const float* alphas = &spline.coefficients[spline.offset(c) + 3];
    double sum = 0, x = 0, y = 0;
    for (int i = 0; i < spline.terms[size_t(c)]; ++i) {
        const glm::dvec2 at = spline.centre(i);
        sum += double(alphas[i]);
        x += double(alphas[i]) * at.x;
        y += double(alphas[i]) * at.y;
    }
    return (std::abs(sum) + std::abs(x) + std::abs(y)) * kLargestPhi <= tolerance;
}

bool hasFactors(const PatchSpline& spline, int channels, double step) {
    if (!spline.centres.empty()) return false;
    const auto& sites = spline.sites;
    const int most = spline.maxTerms(channels);
    if (most > 0 && (sites.size() < kCorners || sites[0] != 0 || sites[1] != 1 || sites[2] != 2))
        return false;
    for (int c = 0; c < channels; ++c)
        if (!keepsSideConditions(spline, c, .1 * step)) return false;
    return true;
}

// Rounds splines over a patch's sites to factors.
class FactorRounding {
  public:
    FactorRounding(const FactorBasis& basis, const FactorColour& colour) : mBasis(basis) {
        const SiteProducts products(basis.basis(), size_t(basis.basis().size()));
        for (size_t c = 0; c < size_t(basis.channels()); ++c) {
            const auto same = std::find(colour.counts.begin(), colour.counts.begin() + c, colour.counts[c]);
            const auto before = size_t(same - colour.counts.begin());
            mNorms.push_back(before < c ? mNorms[before] : products.norms(colour.counts[c]));
        }
    }

    // False where the factors are too large. The spline's sites may be in another order.
    bool round(const PatchSpline& spline, std::array<std::vector<int32_t>, kMaxChannels>& out) const {
        for (size_t c = 0; c < mNorms.size(); ++c) {
            const auto values = mBasis.basis().values(spline, int(c), int(mNorms[c].n));
            if (!roundChannel(mBasis.basis().factors(values), c, out[c])) return false;
        }
        return true;
    }

  private:
    // From the first factor on; what it costs is made good by the later ones.
    bool roundChannel(const std::vector<double>& factors, size_t c, std::vector<int32_t>& out) const {
        const SiteNorms& norms = mNorms[c];
        out.resize(norms.n);
        std::vector<double> errors(norms.n, 0);
        for (size_t k = 0; k < norms.n; ++k) {
            const double step = mBasis.steps(c)[k];
            double wanted = factors[k];
            for (size_t j = 0; j < k; ++j) wanted += norms.at(k, j) / norms.at(k, k) * errors[j];
            if (!(std::abs(wanted / step) < 1e8)) return false;
            out[k] = int32_t(std::lround(wanted / step));
            errors[k] = factors[k] - out[k] * step;
        }
        return true;
    }

    const FactorBasis& mBasis;
    std::vector<SiteNorms> mNorms;
};

}  // namespace

std::vector<double> relativeAreas(const FileMesh& mesh, const FileGeometry& g) {
    std::vector<double> areas;
    double sum = 0;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        double twice = 0;
        for (uint32_t s = 0; s < 3; ++s) {
            const auto& inner = g.inner[mesh.sideEdge[f][s]];
            const bool forward = mesh.forward(f, s);
            const LatticePoint a = g.positions[mesh.triangles[f][s]], b = inner[forward ? 0 : 1],
                               c = inner[forward ? 1 : 0], d = g.positions[mesh.triangles[f][(s + 1) % 3]];
            for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, d)})
                twice += double(from.x) * to.y - double(from.y) * to.x;
        }
        areas.push_back(std::max(twice, 0.0));
        sum += areas.back();
    }
    const double mean = std::max(sum / double(std::max<size_t>(areas.size(), 1)), 1.0);
    for (double& a : areas) a = std::clamp(a / mean, kLeastArea, kLargestArea);
    return areas;
}

double factorStep(double squaredError, double factors) {
    // A factor's squared error over its patch is step^2 / (12 area): over the picture the same for all.
    return std::sqrt(12 * squaredError / (kTrueShare * factors));
}

FactorBasis::FactorBasis(uint32_t version, const FactorColour& colour, int channels, double step, double area)
    : mBasis(SiteLattice::ofVersion(version), colour.sites, colour.counts) {
    const bool foretells = version >= kForetoldNormsVersion;
    if (!foretells) mOnBorder = mBasis.functionsAt(mBasis.lattice().border(), size_t(mBasis.size()));
    std::optional<SiteProducts> products;
    if (!foretells) products.emplace(mBasis, size_t(mBasis.size()));
    for (const uint8_t count : std::span(colour.counts).first(size_t(channels))) {
        std::vector<double> steps =
            foretells ? foretoldNorms(mBasis, count) : products->norms(count).diagonal();
        for (double& s : steps) s = step / std::sqrt(area) / s;
        mSteps.push_back(std::move(steps));
    }
}

std::vector<double> FactorBasis::values(size_t c, std::span<const int32_t> factors) const {
    std::vector<double> values(factors.size());
    for (size_t k = 0; k < values.size(); ++k) values[k] = factors[k] * mSteps[c][k];
    return values;
}

void FactorBasis::evaluateBorder(std::span<const double> values, std::span<double> out) const {
    std::ranges::fill(out, 0);
    if (!mOnBorder.empty()) {
        addRows(values, mOnBorder.data(), out.size(), out);
        return;
    }
    const SiteLattice& lattice = mBasis.lattice();
    const std::vector<double> factors = mBasis.kernelFactors(values);
    for (size_t k = 0; k < factors.size(); ++k)
        addRows({&factors[k], 1}, lattice.borderFunction(mBasis.sites()[k]).data(), 0, out);
}

PatchSpline FactorBasis::spline(const std::array<std::vector<int32_t>, kMaxChannels>& factors) const {
    std::vector<std::vector<double>> kernelFactors;
    for (size_t c = 0; c < mSteps.size(); ++c)
        kernelFactors.push_back(mBasis.kernelFactors(values(c, factors[c])));
    return mBasis.spline(kernelFactors);
}

FactorColour quantizedFactors(const PatchSpline& spline, int channels, double step, double area) {
    FactorColour colour;
    if (hasFactors(spline, channels, step)) {
        uint8_t most = kCorners;
        for (size_t c = 0; c < size_t(channels); ++c) {
            colour.counts[c] = std::max(kCorners, spline.terms[c]);
            most = std::max(most, colour.counts[c]);
        }
        colour.sites = {0, 1, 2};
        if (most > kCorners) colour.sites.assign(spline.sites.begin(), spline.sites.begin() + most);
        const FactorBasis basis(kFormatVersion, colour, channels, step, area);
        const FactorRounding rounding(basis, colour);
        // Factors only where what comes back from them gives them again: by that, and by nothing else, is
        // storing a second time known to give the same bytes.
        if (rounding.round(spline, colour.factors)) {
            const PatchSpline back = basis.spline(colour.factors);
            std::array<std::vector<int32_t>, kMaxChannels> again;
            if (hasFactors(back, channels, step) && rounding.round(back, again) && again == colour.factors)
                return colour;
        }
    }
    colour = {};
    colour.exact = true;
    colour.spline = spline;
    return colour;
}

}  // namespace tessera
