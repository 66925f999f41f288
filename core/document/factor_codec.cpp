// See factor_codec.h; the stream is specified in FORMAT.md.
#include "core/document/factor_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>

#include "core/base/parallel.h"
#include "core/base/row_products.h"

namespace tessera {

namespace {

constexpr size_t kCorners = 3;
constexpr size_t kBlock = 256;  // patches whose bases are held at once
constexpr size_t kGrain = 8;
constexpr size_t kFactorsPerByte = 16;
constexpr double kRate = .16;         // of running means of what was off
constexpr double kCornerSpread = .3;  // what spread() would be of corners
constexpr int64_t kMaxFactor = int64_t{1} << 30;

// An integer that is mostly small: zero, sign, ones up to kUnary, then an exponential Golomb code.
struct FactorModel {
    static constexpr size_t kUnary = 14, kLongest = 31;

    BitModel zero, negative;
    std::array<BitModel, kUnary> more;
    std::array<BitModel, kLongest> longer;
};

template <class Coder>
void codeFactor(Coder& coder, FactorModel& model, int64_t& value) {
    bool zero = value == 0;
    coder.bit(model.zero, zero);
    if (zero) {
        value = 0;
        return;
    }
    bool negative = value < 0;
    coder.bit(model.negative, negative);
    const uint64_t magnitude = Coder::kEncodes ? uint64_t(std::abs(value)) : 0;
    size_t ones = 1;
    for (; ones <= FactorModel::kUnary; ++ones) {
        bool more = magnitude > ones;
        coder.bit(model.more[ones - 1], more);
        if (!more) break;
    }
    uint64_t decoded = ones;
    if (ones > FactorModel::kUnary) {
        uint64_t rest = magnitude - ones + 1;  // at least 1
        size_t length = Coder::kEncodes ? size_t(std::bit_width(rest)) : 1;
        for (size_t i = 1; i < FactorModel::kLongest; ++i) {
            bool more = length > i;
            coder.bit(model.longer[i], more);
            if (!more) break;
            if (!Coder::kEncodes) length = i + 1;
        }
        uint64_t low = rest & ((uint64_t{1} << (length - 1)) - 1);
        coder.plainBits(low, int(length - 1));
        decoded = ones + ((uint64_t{1} << (length - 1)) | low) - 1;
    }
    if (!Coder::kEncodes) value = negative ? -int64_t(decoded) : int64_t(decoded);
}

// How a factor was foreseen.
enum Way : size_t { Across, Alone, Detail, kWays };

constexpr size_t kLevels = 20;
// Two levels to a doubling, level 0 below 1/16.
size_t levelOf(double expected) {
    static constexpr auto kBounds = [] {
        std::array<double, kLevels - 1> bounds{.0625};
        for (size_t i = 1; i < bounds.size(); ++i) bounds[i] = bounds[i - 1] * 1.41421356237309504880;
        return bounds;
    }();
    return size_t(std::ranges::count_if(kBounds, [&](double bound) { return expected >= bound; }));
}

constexpr size_t kShares = 17;  // 16ths
constexpr size_t kMostBorderSites = 3 * kSiteSubdivisions;
static_assert(kMostBorderSites <= 64, "a patch's border sites are bits of a word");

struct Models {
    BitModel exact;
    // Bits from the highest, by those before; by what is around, or by the channel before.
    std::array<std::array<std::array<BitModel, 256>, 4>, kMaxChannels> counts;
    // By the share of places that are still to be taken, the place's ring, and the places around it.
    std::array<std::array<std::array<std::array<BitModel, 3>, 4>, 3>, kShares> taken;
    std::array<std::array<BitModel, kMaxChannels>, kShares> group;
    std::array<std::array<std::array<std::array<FactorModel, 3>, kLevels>, kWays>, kMaxChannels> factors;
    IntModel size;
};

// What later neighbours ask of a patch.
struct Shown {
    bool known = false;  // not exact
    std::array<std::array<float, kMostBorderSites>, kMaxChannels> border{};
    std::array<double, kMaxChannels> detail{}, seam{};  // activities at the end
};

template <class Coder>
class FactorCoder {
  public:
    FactorCoder(Coder& coder, const FactorStream& stream, std::vector<FactorColour>& colours)
        : mCoder(coder),
          mStream(stream),
          mMesh(stream.mesh),
          mLattice(SiteLattice::ofVersion(stream.version)),
          mSubdivisions(size_t(mLattice.subdivisions())),
          mBorder(mLattice.border()),
          mBorderPlaces(mLattice.size(), uint8_t(mBorder.size())),
          mEarlierPlaces(earlierPlaces(mLattice)),
          mColours(colours),
          mShown(colours.size()),
          mBorderTaken(colours.size(), 0) {
        for (size_t i = 0; i < mBorder.size(); ++i) mBorderPlaces[mBorder[i]] = uint8_t(i);
    }

    std::string codeLayouts(size_t streamBytes) {
        size_t factors = 0;
        for (uint32_t f = 0; f < mColours.size(); ++f) {
            FactorColour& colour = mColours[f];
            mCoder.bit(mModels->exact, colour.exact);
            std::string wrong = colour.exact ? codeExact(colour) : codeCounts(f);
            if (wrong.empty() && !colour.exact) wrong = codeSites(f);
            if (!wrong.empty()) return wrong;
            if constexpr (!Coder::kEncodes) {
                if (mCoder.overrun()) return "ends before its colours do";
                for (const uint8_t count : colour.counts) factors += count;
                if (factors / kFactorsPerByte > streamBytes)
                    return "has more factors than its bytes can hold";
            }
        }
        return {};
    }

    // Factors of [begin, end), for which prepare() has been called.
    std::string codePatch(uint32_t f, const std::optional<FactorBasis>& basis) {
        if (!basis) return {};
        for (size_t c = 0; c < channels(); ++c)
            if (auto wrong = codeChannel(f, c, *basis); !wrong.empty()) return wrong;
        mShown[f].known = true;
        return {};
    }

    std::optional<FactorBasis> prepare(uint32_t f) {
        FactorColour& colour = mColours[f];
        if (colour.exact) return {};
        FactorBasis basis(mStream.version, colour, mStream.channels, mStream.step, mStream.areas[f]);
        for (size_t c = 0; c < channels(); ++c) colour.factors[c].resize(colour.counts[c]);
        return basis;
    }

  private:
    size_t channels() const { return size_t(mStream.channels); }

    template <class Visit>
    void forEachEarlier(uint32_t f, Visit&& visit) const {
        for (uint32_t s = 0; s < 3; ++s) {
            const uint32_t g = mMesh.neighbour[f][s];
            if (g != FileMesh::kNone && g < f && !mColours[g].exact) visit(s, g);
        }
    }

    std::string codeCounts(uint32_t f) {
        FactorColour& colour = mColours[f];
        size_t sum = 0, neighbours = 0;
        forEachEarlier(f, [&](uint32_t, uint32_t g) {
            sum += mColours[g].counts[0];
            ++neighbours;
        });
        // 3 where nothing is known, else 0 for few, 1 for some, 2 for many.
        const auto level = [](size_t count, size_t some, size_t many) -> size_t {
            return count < some ? 0 : count < many ? 1 : 2;
        };
        size_t context = neighbours == 0 ? 3 : level(sum / neighbours, 20, 34);
        for (size_t c = 0; c < channels(); ++c) {
            size_t node = 1;
            const size_t highest = mLattice.size() < 128 ? 64 : 128;
            for (size_t bit = highest; bit > 0; bit /= 2) {
                bool set = (colour.counts[c] & bit) != 0;
                mCoder.bit(mModels->counts[c][context][node], set);
                node = 2 * node + size_t(set);
            }
            const size_t count = node - 2 * highest;
            if (count < kCorners || count > mLattice.size()) return "has a number of factors that cannot be";
            colour.counts[c] = uint8_t(count);
            context = c == 0 ? level(count, 20, 34) : level(count, 4, 12);
        }
        return {};
    }

    // 0: not in the list; else the part of the list that it is in, by the different counts in order.
    using Groups = std::array<uint8_t, kCentreSites>;

    static std::vector<size_t> groupSizes(const std::array<uint8_t, kMaxChannels>& counts) {
        std::vector<uint8_t> ends(counts.begin(), counts.end());
        std::sort(ends.begin(), ends.end());
        std::vector<size_t> sizes;
        size_t last = kCorners;
        for (const uint8_t end : ends)
            if (end > last) {
                sizes.push_back(end - last);
                last = end;
            }
        return sizes;
    }

    static size_t shareOf(size_t part, size_t whole) { return part * (kShares - 1) / whole; }

    std::string codeSites(uint32_t f) {
        FactorColour& colour = mColours[f];
        std::vector<size_t> left = groupSizes(colour.counts);
        Groups groups{};
        if constexpr (Coder::kEncodes) {
            size_t at = kCorners;
            for (size_t g = 0; g < left.size(); ++g)
                for (size_t i = 0; i < left[g]; ++i) groups[colour.sites[at++]] = uint8_t(g + 1);
        }
        const std::array<uint8_t, kCentreSites> beyond = sitesBeyond(f);
        size_t total = 0;
        for (const size_t n : left) total += n;
        for (size_t s = kCorners; s < mLattice.size() && total > 0; ++s) {
            const size_t places = mLattice.size() - s;
            bool taken = groups[s] != 0;
            if (total < places)
                mCoder.bit(mModels->taken[shareOf(total, places)][size_t(std::min(mLattice.ring(s), 2))]
                                         [around(groups, s)][beyond[s]],
                           taken);
            else
                taken = true;
            if (!taken) continue;
            groups[s] = uint8_t(codeGroup(groups[s], left, total) + 1);
            --left[groups[s] - 1u];
            --total;
        }
        if constexpr (!Coder::kEncodes) {
            colour.sites = {0, 1, 2};
            for (size_t g = 0; g < left.size(); ++g)
                for (size_t s = kCorners; s < mLattice.size(); ++s)
                    if (groups[s] == g + 1) colour.sites.push_back(uint8_t(s));
        }
        markBorder(f, groups);
        return {};
    }

    size_t codeGroup(size_t group, const std::vector<size_t>& left, size_t total) {
        for (size_t g = 0; g + 1 < left.size(); ++g) {
            if (left[g] == 0) continue;
            if (left[g] == total) return g;
            bool here = group == g + 1;
            mCoder.bit(mModels->group[shareOf(left[g], total)][g], here);
            if (here) return g;
            total -= left[g];
        }
        return left.size() - 1;
    }

    // How many of the places beside it, of those before it, are taken.
    size_t around(const Groups& groups, size_t site) const {
        size_t count = 0;
        for (const uint8_t before : mEarlierPlaces[site]) count += before != site && groups[before] != 0;
        return count;
    }

    // Beside each site, of those before it; the site itself where there is none.
    using EarlierPlaces = std::vector<std::array<uint8_t, 3>>;
    static EarlierPlaces earlierPlaces(const SiteLattice& lattice) {
        EarlierPlaces all(lattice.size());
        constexpr std::array<SitePlace, 3> kSteps{{{-1, 0}, {0, -1}, {1, -1}}};
        for (size_t s = 0; s < all.size(); ++s) {
            all[s].fill(uint8_t(s));
            const SitePlace here = lattice.place(s);
            for (size_t t = kCorners; t < s; ++t)
                for (size_t i = 0; i < kSteps.size(); ++i)
                    if (lattice.place(t).b - here.b == kSteps[i].b &&
                        lattice.place(t).c - here.c == kSteps[i].c)
                        all[s][i] = uint8_t(t);
        }
        return all;
    }

    // For the sites on the border: 1 or 2 where an earlier patch lies there, 2 if it has a site there too.
    std::array<uint8_t, kCentreSites> sitesBeyond(uint32_t f) const {
        std::array<uint8_t, kCentreSites> beyond{};
        forEachEarlier(f, [&](uint32_t s, uint32_t g) {
            const size_t theirs = mMesh.neighbourSide[f][s];
            for (size_t i = 1; i < mSubdivisions; ++i) {
                const size_t there = (theirs + 1) * mSubdivisions - i;
                beyond[mBorder[s * mSubdivisions + i]] = uint8_t(borderTaken(g, there) ? 2 : 1);
            }
        });
        return beyond;
    }

    bool borderTaken(uint32_t g, size_t place) const { return (mBorderTaken[g] >> place & 1) != 0; }
    void markBorder(uint32_t f, const Groups& groups) {
        for (size_t i = 0; i < mBorder.size(); ++i)
            if (groups[mBorder[i]] != 0) mBorderTaken[f] |= uint64_t{1} << i;
    }

    void codeFloat(float& value) {
        uint64_t bits = std::bit_cast<uint32_t>(value);
        mCoder.plainBits(bits, 32);
        value = std::bit_cast<float>(uint32_t(bits));
    }

    bool codeSize(size_t& size, size_t most) {
        auto value = int64_t(size);
        mCoder.number(mModels->size, value);
        if (value < 0 || value > int64_t(most)) return false;
        size = size_t(value);
        return true;
    }

    // Everything of a PatchSpline; what it means is checked by splineViolation.
    std::string codeExact(FactorColour& colour) {
        PatchSpline& spline = colour.spline;
        size_t coefficients = 0, sites = spline.sites.size(), centres = spline.centres.size();
        for (size_t c = 0; c < channels(); ++c) {
            size_t terms = spline.terms[c];
            if (!codeSize(terms, 255)) return "has a number of terms that cannot be";
            spline.terms[c] = uint8_t(terms);
            coefficients += 3 + terms;
        }
        if (!codeSize(sites, kCentreSites) || !codeSize(centres, 255))
            return "has a number of centres that cannot be";
        std::vector<uint8_t> places(spline.sites.begin(), spline.sites.end());
        places.resize(sites);
        spline.centres.resize(centres);
        spline.coefficients.resize(coefficients);
        for (uint8_t& s : places) {
            uint64_t bits = s;
            mCoder.plainBits(bits, 8);
            s = uint8_t(bits);
        }
        spline.sites = places;
        for (glm::vec2& p : spline.centres) {
            codeFloat(p.x);
            codeFloat(p.y);
        }
        for (float& k : spline.coefficients) codeFloat(k);
        return {};
    }

    // What the earlier neighbours tell of channel c of a patch: colours around its border, where no feature
    // lies between; a colour; activities.
    struct Told {
        std::array<double, kMostBorderSites> value{};
        std::array<uint8_t, kMostBorderSites> count{};
        double any = 0, detail = 0, seam = 0;
    };

    Told tell(uint32_t f, size_t c) const {
        Told told;
        double neighbours = 0;
        forEachEarlier(f, [&](uint32_t s, uint32_t g) {
            const Shown& shown = mShown[g];
            const size_t theirs = mMesh.neighbourSide[f][s];
            const bool feature = mStream.featureEdges[mMesh.sideEdge[f][s]];
            for (size_t i = 0; i <= mSubdivisions; ++i) {
                const double value =
                    double(shown.border[c][((theirs + 1) * mSubdivisions - i) % mBorder.size()]);
                if (i == 0) told.any += value;
                if (feature) continue;
                const size_t place = (s * mSubdivisions + i) % mBorder.size();
                told.value[place] += value;
                ++told.count[place];
            }
            told.detail += shown.detail[c];
            told.seam += shown.seam[c];
            ++neighbours;
        });
        for (size_t i = 0; i < mBorder.size(); ++i)
            if (told.count[i] > 1) told.value[i] /= told.count[i];
        if (neighbours == 0) return {{}, {}, 0, mLast[c].detail, mLast[c].seam};
        told.any /= neighbours;
        told.detail /= neighbours;
        told.seam /= neighbours;
        return told;
    }

    std::string codeChannel(uint32_t f, size_t c, const FactorBasis& factorBasis) {
        const SiteBasis& basis = factorBasis.basis();
        std::vector<int32_t>& factors = mColours[f].factors[c];
        const Told told = tell(f, c);
        double detail = told.detail, seam = told.seam;
        std::array<double, kCentreSites> values;  // of the factors so far
        double corners = 0;
        for (size_t k = 0; k < factors.size(); ++k) {
            const size_t place = mBorderPlaces[basis.sites()[k]];
            const double step = factorBasis.steps(c)[k];
            const bool across = place < mBorder.size() && told.count[place] != 0;
            const Way way = across ? Across : k < kCorners ? Alone : Detail;
            const double foreseen = across         ? told.value[place] - sumBefore(basis, k, values.data())
                                    : k < kCorners ? (k == 0 ? told.any : corners / double(k))
                                                   : 0;
            const double spread = basis.spread(k);
            const double scale = way == Across  ? seam
                                 : way == Alone ? detail * kCornerSpread
                                                : detail * spread;
            const int64_t expected = nearest(foreseen / step);
            int64_t off = factors[k] - expected;
            const size_t luma = c == 0 ? 0 : lumaLevel(f, k);
            codeFactor(mCoder, mModels->factors[c][way][levelOf(scale / step)][luma], off);
            if (!Coder::kEncodes) {
                const int64_t factor = expected + off;
                if (std::abs(factor) > kMaxFactor) return "has a factor out of range";
                factors[k] = int32_t(factor);
            }
            const double value = factors[k] * step;
            values[k] = value;
            if (k < kCorners) corners += value;
            const double miss = std::max(std::abs(value - foreseen), .25 * step);
            if (way == Across) seam += (miss - seam) * kRate;
            if (way == Detail) detail += (miss / spread - detail) * kRate;
        }
        Shown& shown = mShown[f];
        std::array<double, kMostBorderSites> border;
        factorBasis.evaluateBorder({values.data(), factors.size()}, {border.data(), mBorder.size()});
        std::copy_n(border.begin(), mBorder.size(), shown.border[c].begin());
        shown.detail[c] = detail;
        shown.seam[c] = seam;
        mLast[c] = {detail, seam};
        return {};
    }

    // At site k the spline of the factors before it.
    static double sumBefore(const SiteBasis& basis, size_t k, const double* values) {
        double sum = 0;
        for (const double function : basis.before(k)) sum += *values++ * function;
        return sum;
    }

    static int64_t nearest(double x) { return int64_t(std::floor(std::clamp(x, -1e9, 1e9) + .5)); }

    // Where brightness has detail, so have the other channels.
    size_t lumaLevel(uint32_t f, size_t k) const {
        const auto& luma = mColours[f].factors[0];
        if (k >= luma.size()) return 0;
        const int32_t size = std::abs(luma[k]);
        return size == 0 ? 0 : size < 3 ? 1 : 2;
    }

    Coder& mCoder;
    const FactorStream& mStream;
    const FileMesh& mMesh;
    const SiteLattice& mLattice;
    size_t mSubdivisions;
    std::span<const uint8_t> mBorder;
    std::vector<uint8_t> mBorderPlaces;  // where on mBorder a site is; its size for those inside
    EarlierPlaces mEarlierPlaces;
    std::vector<FactorColour>& mColours;
    std::vector<Shown> mShown;
    std::vector<uint64_t> mBorderTaken;  // a bit for each of mBorder
    std::unique_ptr<Models> mModels = std::make_unique<Models>();
    struct Activities {
        double detail = 0, seam = 0;
    };
    std::array<Activities, kMaxChannels> mLast{};
};

// Block after block: what takes time apart from the stream is done for many patches at once, for the next
// block while this one's stream is coded.
template <class Coder, class Finish>
std::string codeAll(FactorCoder<Coder>& coder, size_t patches, Finish&& finish) {
    using Prepared = std::vector<std::optional<FactorBasis>>;
    const auto each = [&](size_t first, Prepared& prepared, auto&& visit) {
        parallelFor(std::min(kBlock, patches - first), kGrain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) visit(uint32_t(first + i), prepared[i]);
        });
    };
    const auto prepare = [&](size_t first, Prepared& prepared) {
        if (first >= patches) return;
        each(first, prepared,
             [&](uint32_t f, std::optional<FactorBasis>& basis) { basis = coder.prepare(f); });
    };
    const auto code = [&](size_t first, const Prepared& prepared) -> std::string {
        for (size_t f = first; f < std::min(first + kBlock, patches); ++f)
            if (auto wrong = coder.codePatch(uint32_t(f), prepared[f - first]); !wrong.empty()) return wrong;
        return {};
    };
    Prepared now(std::min(kBlock, patches)), next(now.size());
    prepare(0, now);
    for (size_t first = 0; first < patches; first += kBlock) {
        std::string wrong;
        parallelFor(2, 1, [&](size_t begin, size_t end) {
            if (begin == 0) wrong = code(first, now);
            if (end == 2) prepare(first + kBlock, next);
        });
        if (!wrong.empty()) return wrong;
        each(first, now, finish);
        std::swap(now, next);
    }
    return {};
}

}  // namespace

std::string encodeFactors(RangeEncoder& coder, const FactorStream& stream,
                          std::vector<FactorColour>& colours) {
    FactorCoder factorCoder(coder, stream, colours);
    if (auto wrong = factorCoder.codeLayouts(0); !wrong.empty()) return wrong;
    return codeAll(factorCoder, colours.size(), [](uint32_t, const std::optional<FactorBasis>&) {});
}

std::string decodeFactors(RangeDecoder& coder, const FactorStream& stream, size_t streamBytes,
                          std::vector<PatchSpline>& splines) {
    std::vector<FactorColour> colours(stream.mesh.triangles.size());
    splines.resize(colours.size());
    FactorCoder factorCoder(coder, stream, colours);
    std::string wrong = factorCoder.codeLayouts(streamBytes);
    if (wrong.empty())
        wrong =
            codeAll(factorCoder, colours.size(), [&](uint32_t f, const std::optional<FactorBasis>& basis) {
                splines[f] = basis ? basis->spline(colours[f].factors) : std::move(colours[f].spline);
                colours[f].factors = {};
            });
    return coder.overrun() ? "ends before its colours do" : wrong;
}

size_t leastFactorBytes(const std::vector<FactorColour>& colours, int channels) {
    size_t factors = 0;
    for (const FactorColour& colour : colours)
        for (int c = 0; c < channels; ++c) factors += colour.counts[size_t(c)];
    return factors / kFactorsPerByte + 1;
}

}  // namespace tessera
