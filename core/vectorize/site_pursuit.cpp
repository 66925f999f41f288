// See site_pursuit.h.
#include "core/vectorize/site_pursuit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/row_products.h"
#include "core/mesh/newton_basis.h"
#include "core/vectorize/patch_cells.h"

namespace tessera {

namespace {

using Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr int kCorners = 3;

// By channel, the squared error with 3, 4, ... sites.
using ErrorCurves = std::array<std::vector<float>, kMaxChannels>;

// Site after site the one that takes most of the error that is left, over all channels together: a pivoted
// Cholesky factorization of the Gram matrix of all sites' functions.
class Pursuit {
  public:
    // Among `sites`, of which the corners are the first.
    Pursuit(const PatchCells& cells, const Image& picture, std::span<const uint8_t> sites, int maxTerms)
        : mSites(sites),
          mTaken(Eigen::Index(sites.size()), maxTerms),
          mUsed(sites.size(), false),
          mChannels(picture.channels()) {
        const auto functions = Eigen::Index(sites.size());
        const auto count = Eigen::Index(cells.cells.size());
        RowMajor rows(functions, count);
        evaluateSiteFunctions(sites, cells.x.data(), cells.y.data(), size_t(count), rows.data(),
                              size_t(count));
        MatrixXd targets(count, mChannels);
        for (Eigen::Index k = 0; k < count; ++k)
            for (int c = 0; c < mChannels; ++c)
                targets(k, c) = double(picture.plane(c)[cells.cells[size_t(k)].number]);
        const std::span<const double> values{rows.data(), size_t(rows.size())};
        const std::vector<double> lower = lowerProducts(values, values, sites.size(), size_t(count));
        mGram =
            Eigen::Map<const RowMajor>(lower.data(), functions, functions).selfadjointView<Eigen::Lower>();
        mProducts = rows * targets;
        mNorm = mOwn = mGram.diagonal();
        mLeft = targets.colwise().squaredNorm();
    }

    void run(int most, std::vector<uint8_t>& sites, ErrorCurves& errors) {
        for (int k = 0; k < most; ++k) {
            const int site = k < kCorners ? k : best();
            if (site < 0) return;
            take(site, k);
            sites.push_back(mSites[size_t(site)]);
            if (k + 1 < kCorners) continue;
            for (int c = 0; c < mChannels; ++c) errors[size_t(c)].push_back(float(mLeft(c)));
        }
    }

  private:
    // What is left of a function, once those taken are out of it, must be more than what a renderer's floats
    // make of it.
    static constexpr double kDependent = 1e-6;
    bool independent(int site) const { return mNorm(site) >= kDependent * mOwn(site) && mNorm(site) > 0; }

    int best() const {
        int found = -1;
        double most = 0;
        for (int s = kCorners; s < int(mSites.size()); ++s) {
            if (mUsed[size_t(s)] || !independent(s)) continue;
            const double gain = mProducts.row(s).squaredNorm() / mNorm(s);
            if (gain > most) {
                most = gain;
                found = s;
            }
        }
        return found;
    }

    void take(int site, int k) {
        mUsed[size_t(site)] = true;
        auto column = mTaken.col(k);
        if (!independent(site)) {
            column.setZero();
            return;
        }
        const double root = std::sqrt(mNorm(site));
        column = mGram.col(site);
        const Eigen::VectorXd known = -mTaken.row(site).head(k).transpose();
        addRows({known.data(), size_t(k)}, mTaken.data(), mSites.size(), {column.data(), mSites.size()});
        column /= root;
        const Eigen::RowVectorXd z = mProducts.row(site) / root;
        mProducts.noalias() -= column * z;
        mNorm -= column.cwiseAbs2();
        for (int c = 0; c < mChannels; ++c) mLeft(c) -= z(c) * z(c);
    }

    std::span<const uint8_t> mSites;    // all others here are by place in it
    MatrixXd mGram, mProducts, mTaken;  // products (sites x channels) with what is left of the picture
    Eigen::VectorXd mNorm, mOwn, mLeft;
    std::vector<bool> mUsed;
    int mChannels;
};

// A patch with more cells than this for each site looks at one of three.
constexpr size_t kManyPerSite = 4;
constexpr uint32_t kOneOf = 3;

// Keeps the cells of every third diagonal; each has one sample. `columns` of cells a row.
void keepDiagonals(PatchCells& cells, int columns) {
    size_t kept = 0;
    for (size_t i = 0; i < cells.cells.size(); ++i) {
        const uint32_t number = cells.cells[i].number;
        if ((number % uint32_t(columns) + number / uint32_t(columns)) % kOneOf != 0) continue;
        cells.cells[kept] = cells.cells[i];
        cells.x[kept] = cells.x[i];
        cells.y[kept] = cells.y[i];
        ++kept;
    }
    cells.cells.resize(kept);
    cells.x.resize(kept);
    cells.y.resize(kept);
}

// A number of terms that pays at some price each, and the error with it.
struct Offer {
    uint8_t terms;
    float error;
};
using Offers = std::array<std::vector<Offer>, kMaxChannels>;

// The lower convex hull of a curve of errors, as far as it falls.
std::vector<Offer> offersOf(const std::vector<float>& errors) {
    std::vector<Offer> hull;
    const auto gain = [](const Offer& from, const Offer& to) {
        return double(from.error - to.error) / (to.terms - from.terms);
    };
    for (size_t k = 0; k < errors.size(); ++k) {
        const Offer offer{uint8_t(size_t(kCorners) + k), errors[k]};
        if (!hull.empty() && offer.error >= hull.back().error) continue;
        while (hull.size() > 1 && gain(hull[hull.size() - 2], hull.back()) <= gain(hull.back(), offer))
            hull.pop_back();
        hull.push_back(offer);
    }
    return hull;
}

int worthwhileTerms(const std::vector<Offer>& offers, double price) {
    if (offers.empty()) return kCorners;
    size_t best = 0;
    while (best + 1 < offers.size() && double(offers[best].error - offers[best + 1].error) >
                                           price * (offers[best + 1].terms - offers[best].terms))
        ++best;
    return offers[best].terms;
}

// The same price everywhere, as low as the budget allows.
void spend(const PatchMesh& mesh, const std::vector<Offers>& offers, double budget,
           std::vector<SiteChoice>& choices) {
    const auto choose = [&](double price) {
        double total = 0;
        mesh.forEachPatch([&](PatchId p) {
            for (int c = 0; c < mesh.channels(); ++c)
                total += choices[p.index].terms[size_t(c)] =
                    worthwhileTerms(offers[p.index][size_t(c)], price);
        });
        return total;
    };
    constexpr int kBisections = 40;
    double low = 1e-9, high = 10;
    for (const Offers& own : offers)  // at the price of the best bargain nothing more is bought
        for (const std::vector<Offer>& channel : own)
            if (channel.size() > 1)
                high = std::max(high, double(channel[0].error - channel[1].error) /
                                          (channel[1].terms - channel[0].terms));
    for (int i = 0; i < kBisections; ++i) {
        const double middle = std::sqrt(low * high);
        (choose(middle) > budget ? low : high) = middle;
    }
    choose(high);
}

}  // namespace

int candidateSteps(double termsPerPatch) {
    // Few terms do not need places that lie close, and cost a multiple of the time with them.
    constexpr double kFewTerms = 36;
    static_assert(kSiteSubdivisions % 2 == 0);
    return termsPerPatch <= kFewTerms ? kSiteSubdivisions / 2 : kSiteSubdivisions;
}

std::vector<uint8_t> candidateSites(double termsPerPatch) {
    const int stride = kSiteSubdivisions / candidateSteps(termsPerPatch);
    std::vector<uint8_t> sites;
    for (int s = 0; s < kCentreSites; ++s) {
        const Barycentric b = barycentricOf(centreSites()[size_t(s)]);
        const auto steps = [](double share) { return int(std::lround(share * kSiteSubdivisions)); };
        if (steps(b.y) % stride == 0 && steps(b.z) % stride == 0) sites.push_back(uint8_t(s));
    }
    return sites;
}

std::vector<SiteChoice> chooseSites(const PatchMesh& mesh, const Image& picture, double termsPerPatch,
                                    const ProgressPart& progress) {
    const size_t capacity = mesh.connectivity().faceCapacity();
    std::vector<SiteChoice> choices(capacity);
    std::vector<Offers> offers(capacity);
    TESSERA_CHECK(picture.width() % mesh.width() == 0);
    const FitGrid grid{mesh.width(), mesh.height(), picture.width() / mesh.width(), {}};
    const CellSampler sampler(mesh, grid, 1);
    const std::vector<uint8_t> sites = candidateSites(termsPerPatch);
    std::atomic<size_t> done = 0;
    parallelFor(sampler.patches().size(), 4, [&](size_t begin, size_t end) {
        PatchCells cells;
        for (size_t i = begin; i < end; ++i) {
            if (!progress.step(double(done++) / double(sampler.patches().size()))) return;
            sampler.sample(i, cells);
            if (cells.cells.empty()) continue;
            const uint32_t p = sampler.patches()[i].index;
            const int most = std::clamp(int(cells.cells.size()), kCorners, int(sites.size()));
            const bool thinned = cells.cells.size() > kManyPerSite * sites.size();
            if (thinned) keepDiagonals(cells, picture.width());
            ErrorCurves errors;
            Pursuit(cells, picture, sites, most).run(most, choices[p].sites, errors);
            for (size_t c = 0; c < errors.size(); ++c) {
                for (float& error : errors[c]) error *= thinned ? kOneOf : 1;
                offers[p][c] = offersOf(errors[c]);
            }
        }
    });
    if (progress.stopRequested()) return {};
    spend(mesh, offers, termsPerPatch * double(mesh.patchCount()), choices);
    mesh.forEachPatch([&](PatchId p) {
        SiteChoice& choice = choices[p.index];
        if (choice.sites.empty()) choice.sites = {0, 1, 2};
        choice.sites.resize(size_t(*std::max_element(choice.terms.begin(), choice.terms.end())));
    });
    return choices;
}

}  // namespace tessera
