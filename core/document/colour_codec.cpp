// See colour_codec.h. Values are predicted from the neighbour across an edge without a feature, else from
// within the patch, and then from the green channel's own surprise at the same place.
#include "core/document/colour_codec.h"

#include <algorithm>
#include <bit>
#include <memory>

namespace tessera {

namespace {

constexpr size_t kActivities = 12;
constexpr int64_t kMaxValue = int64_t{1} << 40;
constexpr int kSidePlaces = 9;  // of the centres, those on the boundary

// How a centre's value was foreseen: each way errs by a measure of its own.
enum Way : size_t { Corner, CornerAlone, Side, SideAlone, Middle, kWays };

// On side s, from its first corner on: the centres on it.
constexpr std::array<std::array<size_t, 4>, 3> kOnSide{{{0, 3, 4, 1}, {1, 5, 6, 2}, {2, 7, 8, 0}}};
// The centres around each of the six inner middles, 10 to 15.
constexpr std::array<std::array<size_t, 3>, 6> kAround{
    {{0, 3, 8}, {1, 4, 5}, {2, 6, 7}, {3, 4, 9}, {5, 6, 9}, {7, 8, 9}}};

struct Models {
    // Green, or another channel given green.
    std::array<std::array<std::array<IntModel, kActivities>, kWays>, 2> values;
    BitModel exact, sameTerms;
    IntModel terms, centreCount;
};

int64_t mean(std::initializer_list<int64_t> values) {
    int64_t sum = 0;
    for (const int64_t v : values) sum += v;
    const auto count = int64_t(values.size());
    return (sum + (sum < 0 ? -count / 2 : count / 2)) / count;
}

template <class Coder>
class ColourCoder {
  public:
    ColourCoder(Coder& coder, const FileMesh& mesh, const std::vector<bool>& featureEdges, int channels,
                std::vector<FileColour>& colours)
        : mCoder(coder), mMesh(mesh), mFeatureEdges(featureEdges), mChannels(channels), mColours(colours) {}

    std::string run() {
        for (uint32_t f = 0; f < mMesh.triangles.size(); ++f) {
            FileColour& colour = mColours[f];
            if (auto wrong = codeLayout(colour); !wrong.empty()) return wrong;
            if (ended()) return {};
            if (colour.exact) {
                codeExact(colour);
                continue;
            }
            mSurprise = {};
            for (const size_t c : channelOrder())
                if (auto wrong = codeChannel(f, c); !wrong.empty()) return wrong;
        }
        return {};
    }

  private:
    std::vector<size_t> channelOrder() const {
        return mChannels == 4 ? std::vector<size_t>{1, 0, 2, 3} : std::vector<size_t>{1, 0, 2};
    }

    std::string codeLayout(FileColour& colour) {
        mCoder.bit(mModels->exact, colour.exact);
        bool same = colour.terms == mLastTerms;
        mCoder.bit(mModels->sameTerms, same);
        if (same) {
            colour.terms = mLastTerms;
        } else {
            for (size_t c = 0; c < size_t(mChannels); ++c) {
                int64_t terms = colour.terms[c];
                mCoder.number(mModels->terms, terms);
                if (terms < 0 || terms > 255 || terms == 1 || terms == 2)
                    return "has a number of terms that cannot be";
                colour.terms[c] = uint8_t(terms);
            }
            mLastTerms = colour.terms;
        }
        for (const uint8_t terms : colour.terms)
            if (!colour.exact && terms > kDefaultCentreCount) return "has more terms than centres";
        if (Coder::kEncodes || colour.exact) return {};
        for (size_t c = 0; c < size_t(mChannels); ++c)
            colour.values[c].resize(std::max<size_t>(3, colour.terms[c]));
        return {};
    }

    bool ended() const {
        if constexpr (Coder::kEncodes)
            return false;
        else
            return mCoder.overrun();
    }

    void codeFloat(float& value) {
        uint64_t bits = std::bit_cast<uint32_t>(value);
        mCoder.plainBits(bits, 32);
        value = std::bit_cast<float>(uint32_t(bits));
    }

    void codeExact(FileColour& colour) {
        int64_t centres = int64_t(colour.centres.size());
        mCoder.number(mModels->centreCount, centres);
        size_t coefficients = 0;
        for (size_t c = 0; c < size_t(mChannels); ++c) coefficients += 3u + colour.terms[c];
        if (!Coder::kEncodes) {
            colour.centres.resize(size_t(std::clamp<int64_t>(centres, 0, 255)));
            colour.coefficients.resize(coefficients);
        }
        for (glm::vec2& p : colour.centres) {
            codeFloat(p.x);
            codeFloat(p.y);
        }
        for (float& k : colour.coefficients) codeFloat(k);
    }

    // What the earlier neighbours have at the boundary centres of triangle f: sums and how many.
    struct Seen {
        std::array<int64_t, kSidePlaces> sum{}, count{};
        int64_t anySum = 0, anyCount = 0;  // across features too
    };
    Seen lookAround(uint32_t f, size_t c) const {
        Seen seen;
        for (uint32_t s = 0; s < 3; ++s) {
            const uint32_t g = mMesh.neighbour[f][s];
            if (g == FileMesh::kNone || g >= f || mColours[g].exact) continue;
            const auto& theirs = mColours[g].values[c];
            const bool feature = mFeatureEdges[mMesh.sideEdge[f][s]];
            for (size_t i = 0; i < 4; ++i) {
                const size_t place = kOnSide[mMesh.neighbourSide[f][s]][3 - i];
                if (place >= theirs.size()) continue;
                seen.anySum += theirs[place];
                ++seen.anyCount;
                if (feature) continue;
                seen.sum[kOnSide[s][i]] += theirs[place];
                ++seen.count[kOnSide[s][i]];
            }
        }
        return seen;
    }

    std::string codeChannel(uint32_t f, size_t c) {
        std::vector<int64_t>& values = mColours[f].values[c];
        const Seen seen = lookAround(f, c);
        const auto foreseen = [&](size_t i) { return i < kSidePlaces && seen.count[i] != 0; };
        const auto fromOutside = [&](size_t i) {
            return (seen.sum[i] + (seen.sum[i] < 0 ? -seen.count[i] / 2 : seen.count[i] / 2)) / seen.count[i];
        };
        // Corners that a neighbour foretells come first: the others lean on them.
        std::array<size_t, 3> corners{0, 1, 2};
        std::stable_sort(corners.begin(), corners.end(),
                         [&](size_t a, size_t b) { return foreseen(a) > foreseen(b); });
        std::array<bool, 3> known{};
        int64_t activity = mActivity[c];
        bool good = true;
        const auto code = [&](size_t i, Way way, int64_t expected) {
            good = good && codeValue(c, i, way, expected, activity, values[i]);
        };
        for (const size_t i : corners) {
            int64_t sum = 0, count = 0;
            for (size_t j = 0; j < 3; ++j)
                if (known[j]) {
                    sum += values[j];
                    ++count;
                }
            if (foreseen(i))
                code(i, Corner, fromOutside(i));
            else if (count != 0)
                code(i, CornerAlone, sum / count);
            else
                code(i, CornerAlone, seen.anyCount != 0 ? seen.anySum / seen.anyCount : mLastCorner[c]);
            known[i] = true;
        }
        mLastCorner[c] = values[0];
        for (size_t i = 3; i < std::min<size_t>(values.size(), kSidePlaces); ++i) {
            const size_t near = i % 2 == 1 ? (i - 3) / 2 : ((i - 3) / 2 + 1) % 3;
            const size_t far = i % 2 == 1 ? ((i - 3) / 2 + 1) % 3 : (i - 3) / 2;
            if (foreseen(i))
                code(i, Side, fromOutside(i));
            else
                code(i, SideAlone, mean({values[near], values[near], values[far]}));
        }
        if (values.size() > 9)
            code(9, Middle, mean({values[3], values[4], values[5], values[6], values[7], values[8]}));
        for (size_t i = 10; i < values.size(); ++i) {
            const auto& around = kAround[i - 10];
            code(i, Middle, mean({values[around[0]], values[around[1]], values[around[2]]}));
        }
        mActivity[c] = activity;
        return good ? "" : "has a colour out of range";
    }

    // `activity` is a running mean of 16 times how far off values were.
    bool codeValue(size_t c, size_t i, Way way, int64_t expected, int64_t& activity, int64_t& value) {
        constexpr size_t kGreen = 1;
        if (c != kGreen) expected += mSurprise[i];
        int64_t off = value - expected;
        const auto level = std::min<size_t>(size_t(bitLength(activity >> 2)), kActivities - 1);
        mCoder.number(mModels->values[c != kGreen][way][level], off);
        if (!Coder::kEncodes) value = expected + off;
        if (c == kGreen) mSurprise[i] = off;
        activity += (16 * std::abs(off) - activity) / 4;
        return std::abs(value) < kMaxValue;
    }

    Coder& mCoder;
    const FileMesh& mMesh;
    const std::vector<bool>& mFeatureEdges;
    int mChannels;
    std::vector<FileColour>& mColours;
    std::unique_ptr<Models> mModels = std::make_unique<Models>();
    std::array<uint8_t, kMaxChannels> mLastTerms{};
    std::array<int64_t, kMaxChannels> mLastCorner{}, mActivity{};
    std::array<int64_t, kDefaultCentreCount> mSurprise{};  // of green at each centre of the patch
};

}  // namespace

std::string encodeColours(RangeEncoder& coder, const FileMesh& mesh, const std::vector<bool>& featureEdges,
                          int channels, std::vector<FileColour>& colours) {
    return ColourCoder(coder, mesh, featureEdges, channels, colours).run();
}

std::string decodeColours(RangeDecoder& coder, const FileMesh& mesh, const std::vector<bool>& featureEdges,
                          int channels, std::vector<FileColour>& colours) {
    colours.assign(mesh.triangles.size(), {});
    std::string wrong = ColourCoder(coder, mesh, featureEdges, channels, colours).run();
    return coder.overrun() ? "ends before its colours do" : wrong;
}

}  // namespace tessera
