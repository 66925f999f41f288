// See site_fit.h.
#include "core/edit/site_fit.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>

#include "core/base/round_up.h"
#include "core/base/row_products.h"
#include "core/base/vectors.h"
#include "core/mesh/newton_basis.h"

namespace tessera {

namespace {

constexpr size_t kSites = kCentreSites;
constexpr size_t kCorners = 3;
constexpr size_t kPolynomials = 3;
// Functions are taken eight at a time, one a lane.
constexpr size_t kLanes = 8;
// A spline's own sites and all others, both in whole batches.
constexpr size_t kMostFunctions = kSitePlane + 2 * kLanes;

// Near enough that no more of a spline's own sites are asked for, where it changes; and what is not seen.
constexpr double kNear = .2 / 255, kUnseen = .02 / 255;

using Quad = Vector<double, 4>;

TESSERA_INLINE void load(const double* from, Quad& to) {
    std::memcpy(&to, from, sizeof to);
}
TESSERA_INLINE void store(const Quad& from, double* to) {
    std::memcpy(to, &from, sizeof from);
}
TESSERA_INLINE double total(const Quad& v) {
    return (v[0] + v[2]) + (v[1] + v[3]);
}

// The functions of all sites (evaluateSiteFunctions) at all sites, and their weighted products.
struct Tables {
    std::array<SitePlane, kSites> functions{};
    std::array<std::array<double, kSites>, kSites> products{};

    Tables() {
        const SitePoints& points = sitePoints();
        std::array<uint8_t, kSites> sites;
        for (size_t s = 0; s < kSites; ++s) sites[s] = uint8_t(s);
        std::vector<double> values(kSites * kSites);
        evaluateSiteFunctions(sites, points.domain.x.data(), points.domain.y.data(), kSites, values.data(),
                              kSites);
        std::vector<double> weighted(values);
        for (size_t s = 0; s < kSites; ++s)
            for (size_t i = 0; i < kSites; ++i) {
                functions[s][i] = float(values[s * kSites + i]);
                weighted[s * kSites + i] *= double(points.weights[i]);
            }
        const std::vector<double> lower = lowerProducts(weighted, values, kSites, kSites);
        for (size_t s = 0; s < kSites; ++s)
            for (size_t t = 0; t <= s; ++t) products[s][t] = products[t][s] = lower[s * kSites + t];
    }
};

const Tables& tables() {
    static const auto made = std::make_unique<const Tables>();
    return *made;
}

// A lane without a function.
constexpr int kNone = -1;

// The normal equations of a growing list of functions, L L^T x = b, and y with L y = b: how much of the
// weighted squares of the values goes with function k beyond those before it is y_k^2.
struct Equations {
    int channels = 0;
    size_t count = 0;            // functions, in whole batches of lanes
    std::vector<int16_t> sites;  // of the functions; kNone
    // Row k of L is in lane k % kLanes of batch k / kLanes, which has an entry for each function before its
    // end.
    std::vector<double> factor;
    std::array<std::array<double, kMostFunctions>, kMaxChannels> y;

    double* batch(size_t first) { return factor.data() + first * (first + kLanes) / 2; }
    const double* batch(size_t first) const { return factor.data() + first * (first + kLanes) / 2; }
};

// The right side of a batch: products of its functions with weighted values.
TESSERA_INLINE void addProducts(const Tables& t, const SitePlanes& weighted, Equations& e, size_t first) {
    for (size_t lane = 0; lane < kLanes; ++lane) {
        const int site = e.sites[first + lane];
        for (int c = 0; c < e.channels; ++c) {
            double& to = e.y[size_t(c)][first + lane];
            to = site == kNone ? 0 : siteProduct(t.functions[size_t(site)], weighted[size_t(c)]);
        }
    }
}

// The rows of a batch before its own functions: products of functions to rows of L.
TESSERA_INLINE void substitute(Equations& e, size_t first) {
    double* const rows = e.batch(first);
    for (size_t begin = 0; begin < first; begin += kLanes) {
        const double* const above = e.batch(begin);
        // Within a batch of columns one after the other; what they take from later ones all at once.
        for (size_t i = 0; i < begin; ++i) {
            Quad low, high;
            load(rows + i * kLanes, low);
            load(rows + i * kLanes + 4, high);
            for (size_t j = 0; j < kLanes; ++j) {
                double* const to = rows + (begin + j) * kLanes;
                const double share = above[i * kLanes + j];
                Quad a, b;
                load(to, a);
                load(to + 4, b);
                store(a - share * low, to);
                store(b - share * high, to + 4);
            }
        }
        for (size_t j = 0; j < kLanes; ++j) {
            double* const to = rows + (begin + j) * kLanes;
            Quad a, b;
            load(to, a);
            load(to + 4, b);
            for (size_t i = 0; i < j; ++i) {
                Quad low, high;
                load(rows + (begin + i) * kLanes, low);
                load(rows + (begin + i) * kLanes + 4, high);
                const double share = above[(begin + i) * kLanes + j];
                a -= share * low;
                b -= share * high;
            }
            const double inverse = 1 / above[(begin + j) * kLanes + j];
            store(a * inverse, to);
            store(b * inverse, to + 4);
        }
    }
}

// A batch's own functions: their part of L, and y.
TESSERA_INLINE void factorize(Equations& e, size_t first) {
    double* const rows = e.batch(first);
    double* const own = rows + first * kLanes;  // [column][lane]
    for (size_t i = 0; i < first; ++i) {
        const double* const from = rows + i * kLanes;
        Quad low, high;
        load(from, low);
        load(from + 4, high);
        for (size_t j = 0; j < kLanes; ++j) {
            Quad a, b;
            load(own + j * kLanes, a);
            load(own + j * kLanes + 4, b);
            store(a - from[j] * low, own + j * kLanes);
            store(b - from[j] * high, own + j * kLanes + 4);
        }
    }
    for (int c = 0; c < e.channels; ++c) {
        double* const y = e.y[size_t(c)].data();
        Quad low, high;
        load(y + first, low);
        load(y + first + 4, high);
        for (size_t i = 0; i < first; ++i) {
            Quad a, b;
            load(rows + i * kLanes, a);
            load(rows + i * kLanes + 4, b);
            low -= y[i] * a;
            high -= y[i] * b;
        }
        store(low, y + first);
        store(high, y + first + 4);
    }
    for (size_t j = 0; j < kLanes; ++j) {
        const double root = std::sqrt(own[j * kLanes + j]), inverse = 1 / root;
        own[j * kLanes + j] = root;
        for (size_t lane = j + 1; lane < kLanes; ++lane) own[j * kLanes + lane] *= inverse;
        for (size_t k = j + 1; k < kLanes; ++k)
            for (size_t lane = k; lane < kLanes; ++lane)
                own[k * kLanes + lane] -= own[j * kLanes + k] * own[j * kLanes + lane];
        for (int c = 0; c < e.channels; ++c) {
            double* const y = e.y[size_t(c)].data() + first;
            y[j] *= inverse;
            for (size_t lane = j + 1; lane < kLanes; ++lane) y[lane] -= own[j * kLanes + lane] * y[j];
        }
    }
}

// Takes the next batch of e.sites in.
TESSERA_VECTOR_CLONES
void addBatch(const Tables& t, const SitePlanes& weighted, Equations& e) {
    const size_t first = e.count;
    e.count += kLanes;
    e.factor.resize(e.count * (e.count + kLanes) / 2);
    addProducts(t, weighted, e, first);
    // Sites may be as many as points.
    constexpr double kRidge = 1e-9;
    double* const rows = e.batch(first);
    for (size_t lane = 0; lane < kLanes; ++lane) {
        const int site = e.sites[first + lane];
        for (size_t k = 0; k < e.count; ++k) {
            const int other = e.sites[k];
            const bool known = site != kNone && other != kNone;
            rows[k * kLanes + lane] = known ? t.products[size_t(site)][size_t(other)] : 0;
        }
        double& own = rows[(first + lane) * kLanes + lane];
        own = site == kNone ? 1 : (1 + kRidge) * own;
    }
    substitute(e, first);
    factorize(e, first);
}

// x of the first functions of each channel.
TESSERA_VECTOR_CLONES
void solve(const Equations& e, const std::array<size_t, kMaxChannels>& lengths,
           std::array<std::array<double, kMostFunctions>, kMaxChannels>& x) {
    for (int c = 0; c < e.channels; ++c) {
        double* const to = x[size_t(c)].data();
        const size_t length = lengths[size_t(c)], end = roundUp(length, kLanes);
        std::fill_n(to, end, 0.0);
        for (size_t k = length; k-- > 0;) {
            Quad sum{};
            for (size_t first = k / kLanes * kLanes; first < end; first += kLanes) {
                const double* const column = e.batch(first) + k * kLanes;
                Quad a, b, u, v;
                load(column, a);
                load(column + 4, b);
                load(to + first, u);
                load(to + first + 4, v);
                sum += a * u + b * v;
            }
            const size_t own = k / kLanes * kLanes;
            to[k] = (e.y[size_t(c)][k] - total(sum)) / e.batch(own)[k * kLanes + k - own];
        }
    }
}

// Takes the fitted functions from values.
TESSERA_VECTOR_CLONES
void subtract(const Tables& t, const Equations& e,
              const std::array<std::array<double, kMostFunctions>, kMaxChannels>& x, SitePlanes& values) {
    for (int c = 0; c < e.channels; ++c) {
        float* const to = values[size_t(c)].data();
        for (size_t k = 0; k < e.count; ++k) {
            if (e.sites[k] == kNone) continue;
            const float share = float(x[size_t(c)][k]);
            const float* const function = t.functions[size_t(e.sites[k])].data();
            for (size_t i = 0; i < kSitePlane; ++i) to[i] -= share * function[i];
        }
    }
}

bool areNeighbours(size_t a, size_t b) {
    constexpr double kNearest = 1.1 / kSiteSubdivisions;
    const glm::dvec2 d = centreSites()[a] - centreSites()[b];
    return d.x * d.x + d.y * d.y < kNearest * kNearest;
}

// One fit: batches of functions, those of the given sites and then where most is missing.
class Fit {
  public:
    // Takes the own sites until the deviation is `near`.
    Fit(std::span<const uint8_t> own, int channels, const SitePlanes& values, double near) : mValues(values) {
        mEquations.channels = channels;
        for (size_t c = 0; c < size_t(channels); ++c)
            for (size_t i = 0; i < kSitePlane; ++i) {
                mWeighted[c][i] = sitePoints().weights[i] * values[c][i];
                mLeft += double(mWeighted[c][i]) * double(values[c][i]);
            }
        mEquations.sites.assign(own.begin(), own.end());
        fillUp();
        const double perSquare = sitePoints().weight * channels;
        while (mEquations.count < mEquations.sites.size() && mLeft > near * near * perSquare) add();
        while (mLeft > kFitTolerance * kFitTolerance * perSquare && addSites()) add();
        shorten(near * near * perSquare);
    }

    const std::vector<int16_t>& sites() const { return mEquations.sites; }
    // Functions of channel c.
    size_t length(size_t c) const { return mLengths[c]; }
    double share(size_t c, size_t k) const { return mShares[c][k]; }

  private:
    void fillUp() {
        while (mEquations.sites.size() % kLanes != 0) mEquations.sites.push_back(kNone);
    }

    void add() {
        const size_t first = mEquations.count;
        addBatch(tables(), mWeighted, mEquations);
        for (size_t c = 0; c < size_t(mEquations.channels); ++c)
            for (size_t k = first; k < mEquations.count; ++k)
                mLeft -= mEquations.y[c][k] * mEquations.y[c][k];
    }

    // Further sites, where most is missing, if possible no two of them side by side; false where there are
    // none, or where the deviation is within the tolerance after all.
    bool addSites() {
        mLengths.fill(mEquations.count);
        solve(mEquations, mLengths, mShares);
        SitePlanes rest = mValues;
        subtract(tables(), mEquations, mShares, rest);
        std::array<float, kSites> missing{};
        double sum = 0;
        for (size_t c = 0; c < size_t(mEquations.channels); ++c)
            for (size_t i = 0; i < kSites; ++i) {
                missing[i] += rest[c][i] * rest[c][i];
                sum += double(sitePoints().weights[i]) * double(std::abs(rest[c][i]));
            }
        if (sum <= kFitTolerance * sitePoints().weight * mEquations.channels) return false;
        for (const int16_t s : mEquations.sites)
            if (s != kNone) missing[size_t(s)] = -1;
        const size_t before = mEquations.sites.size();
        for (const bool apart : {true, false}) {
            auto left = missing;
            while (mEquations.sites.size() < before + kLanes) {
                const auto worst = std::max_element(left.begin(), left.end());
                if (*worst < 0) break;
                const auto site = size_t(worst - left.begin());
                mEquations.sites.push_back(int16_t(site));
                missing[site] = left[site] = -1;
                for (size_t i = 0; i < kSites && apart; ++i)
                    if (areNeighbours(i, site)) left[i] = -1;
            }
        }
        const bool found = mEquations.sites.size() > before;
        fillUp();
        return found;
    }

    // Leaves out functions from the end of each channel, as long as the fit is within `enough` or what they
    // do is not seen.
    void shorten(double enough) {
        const auto channels = size_t(mEquations.channels);
        const double spare =
            std::max(kUnseen * kUnseen * sitePoints().weight, (enough - mLeft) / double(channels));
        for (size_t c = 0; c < channels; ++c) {
            size_t& length = mLengths[c];
            length = mEquations.count;
            double dropped = 0;
            while (length > kCorners) {
                const double last = mEquations.y[c][length - 1];
                dropped += last * last;
                if (dropped > spare) break;
                --length;
            }
            while (length > kCorners && mEquations.sites[length - 1] == kNone) --length;
        }
        solve(mEquations, mLengths, mShares);
    }

    const SitePlanes& mValues;
    SitePlanes mWeighted{};
    Equations mEquations;
    double mLeft = 0;  // weighted squares
    std::array<size_t, kMaxChannels> mLengths{};
    // Zero where no function is needed.
    std::array<std::array<double, kMostFunctions>, kMaxChannels> mShares{};
};

// The coefficients of a channel of a fit, its alphas in the order of `places` (a site's place in a list).
void addChannel(const Fit& fit, size_t c, std::span<const uint8_t> places, float* k) {
    constexpr double kHalfOverHeight = .5 / kDomainHeight;
    const double a = fit.share(c, 0), b = fit.share(c, 1), d = fit.share(c, 2);
    k[0] += float(a);
    k[1] += float(b - a);
    k[2] += float(d / kDomainHeight - kHalfOverHeight * (a + b));
    if (fit.length(c) <= kCorners) return;
    glm::dvec3 corners(0);
    for (size_t i = kCorners; i < fit.length(c); ++i) {
        if (fit.sites()[i] == kNone) continue;
        const auto site = size_t(fit.sites()[i]);
        k[kPolynomials + places[site]] += float(fit.share(c, i));
        corners -= fit.share(c, i) * sitePoints().barycentrics[site];
    }
    for (int i = 0; i < int(kCorners); ++i) k[int(kPolynomials) + i] += float(corners[i]);
}

// The spline, whose sites are `sites`, and a fit whose first functions are of them.
PatchSpline sumOf(const PatchSpline& spline, std::vector<uint8_t> sites, int channels, const Fit& fit) {
    constexpr uint8_t kNew = 255;
    std::array<uint8_t, kSites> places;
    places.fill(kNew);
    for (size_t i = 0; i < sites.size(); ++i) places[sites[i]] = uint8_t(i);
    PatchSpline result;
    size_t most = 0;
    for (size_t c = 0; c < size_t(channels); ++c) {
        size_t terms = spline.terms[c];
        for (size_t k = kCorners; k < fit.length(c); ++k) {
            const int site = fit.sites()[k];
            if (site == kNone) continue;
            if (places[size_t(site)] == kNew) {
                places[size_t(site)] = uint8_t(sites.size());
                sites.push_back(uint8_t(site));
            }
            terms = std::max(terms, size_t(places[size_t(site)]) + 1);
        }
        result.terms[c] = uint8_t(terms);
        most = std::max(most, terms);
    }
    sites.resize(most);
    result.sites = sites;
    result.coefficients.assign(result.offset(channels), 0.F);
    for (size_t c = 0; c < size_t(channels); ++c) {
        float* const to = result.coefficients.data() + result.offset(int(c));
        std::copy_n(spline.coefficients.data() + spline.offset(int(c)), kPolynomials + spline.terms[c], to);
        addChannel(fit, c, places, to);
    }
    return result;
}

PatchSpline zeroSpline(int channels) {
    constexpr std::array<float, kMaxChannels> kZero{};
    return constantSpline({kZero.data(), size_t(channels)});
}

bool hasSites(const PatchSpline& spline) {
    return spline.sites.size() >= kCorners && spline.sites[0] == 0 && spline.sites[1] == 1 &&
           spline.sites[2] == 2;
}

// Where a fit begins that has nothing to be added to.
std::vector<uint8_t> firstSites(const PatchSpline& like) {
    if (hasSites(like)) return {like.sites.begin(), like.sites.end()};
    return like.maxTerms(kMaxChannels) > 0 ? usualSites() : std::vector<uint8_t>{0, 1, 2};
}

}  // namespace

PatchSpline withAdded(const PatchSpline& spline, int channels, const SitePlanes& values) {
    if (hasSites(spline) || spline.maxTerms(channels) == 0) {
        std::vector<uint8_t> sites = firstSites(spline);
        const Fit fit(sites, channels, values, kNear);
        return sumOf(spline, std::move(sites), channels, fit);
    }
    SitePlanes whole{};
    const DomainPoints& points = sitePoints().domain;
    evaluateSplines(spline, channels, points.x.data(), points.y.data(), kSites, pointersTo(whole).data());
    for (size_t c = 0; c < size_t(channels); ++c)
        for (size_t i = 0; i < kSites; ++i) whole[c][i] += values[c][i];
    return fittedLike(spline, channels, whole);
}

PatchSpline fittedLike(const PatchSpline& like, int channels, const SitePlanes& values) {
    std::vector<uint8_t> sites = firstSites(like);
    const Fit fit(sites, channels, values, kUnseen);
    return sumOf(zeroSpline(channels), std::move(sites), channels, fit);
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

}  // namespace tessera
