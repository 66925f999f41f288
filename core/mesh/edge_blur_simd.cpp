// Blurred features at many points of a patch: addBlur, the fast twin of blurredColour (edge_blur.h). Lengths
// are in single precision, in image pixels from an origin of the patch's own.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/check.h"
#include "core/base/round_up.h"
#include "core/base/vectors.h"
#include "core/mesh/edge_blur.h"

namespace tessera {

namespace {

// Eight points side by side: the compiler makes the machine's instructions of them.
constexpr size_t kVector = 8;
using Lanes = Vector<float, kVector>;
using Mask = Vector<int32_t, kVector>;

struct LaneSegment {
    float fromX, fromY, alongX, alongY, inverse;

    LaneSegment() = default;
    LaneSegment(const EdgeBlur::Segment& s, glm::dvec2 origin)
        : fromX(float(s.from.x - origin.x)),
          fromY(float(s.from.y - origin.y)),
          alongX(float(s.along.x)),
          alongY(float(s.along.y)),
          inverse(float(s.inverse)) {}
};

// What EdgeBlur::Feature is to one point, for many.
struct LaneFeature {
    bool even;
    LaneSegment base;
    LaneSegment chords[EdgeBlur::kSegments];
    float x[4], y[4];  // the curve in powers of t

    LaneFeature(const EdgeBlur::Feature& f, glm::dvec2 origin) : even(f.even), base(f.base, origin) {
        if (!even)
            for (size_t i = 0; i < EdgeBlur::kSegments; ++i) chords[i] = {f.chords[i], origin};
        const auto& p = f.curve.p;
        const glm::dvec2 powers[] = {p[0] - origin, 3.0 * (p[1] - p[0]), 3.0 * (p[2] - 2.0 * p[1] + p[0]),
                                     p[3] - 3.0 * (p[2] - p[1]) - p[0]};
        for (size_t i = 0; i < 4; ++i) {
            x[i] = float(powers[i].x);
            y[i] = float(powers[i].y);
        }
    }
};

TESSERA_INLINE void load(const float* from, Lanes& to) {
    std::memcpy(&to, from, sizeof to);
}
TESSERA_INLINE void store(const Lanes& from, float* to) {
    std::memcpy(to, &from, sizeof from);
}
TESSERA_INLINE bool any(const Mask& mask) {
    int64_t parts[sizeof mask / sizeof(int64_t)];
    std::memcpy(parts, &mask, sizeof mask);
    return (parts[0] | parts[1] | parts[2] | parts[3]) != 0;
}

// The nearest point's share of the segment and the square of its distance.
TESSERA_INLINE void nearest(const LaneSegment& l, const Lanes& x, const Lanes& y, Lanes& share,
                            Lanes& squared) {
    const Lanes dx = x - l.fromX, dy = y - l.fromY, zero = {}, one = zero + 1;
    Lanes s = (dx * l.alongX + dy * l.alongY) * l.inverse;
    s = s < zero ? zero : s;
    s = s > one ? one : s;
    const Lanes offX = dx - s * l.alongX, offY = dy - s * l.alongY;
    share = s;
    squared = offX * offX + offY * offY;
}

// From the point to the feature's at t.
TESSERA_INLINE void offsetAt(const LaneFeature& f, const Lanes& x, const Lanes& y, const Lanes& t,
                             Lanes& offX, Lanes& offY) {
    offX = (f.x[0] - x) + t * (f.x[1] + t * (f.x[2] + t * f.x[3]));
    offY = (f.y[0] - y) + t * (f.y[1] + t * (f.y[2] + t * f.y[3]));
}

// Newton's method on (B(t) - at) . B'(t) = 0, inside [t - span, t + span]. A point that has done stays as it
// is while its neighbours go on.
TESSERA_INLINE void refine(const LaneFeature& f, const Lanes& x, const Lanes& y, float span, Lanes& t) {
    constexpr int kSteps = 5;
    constexpr float kEnough = 1e-4F;  // the error left is about its square
    const Lanes zero = {}, one = zero + 1;
    Lanes lo = t - span, hi = t + span;
    lo = lo < zero ? zero : lo;
    hi = hi > one ? one : hi;
    Mask active = zero == zero;
    for (int i = 0; i < kSteps && any(active); ++i) {
        Lanes rx, ry;
        offsetAt(f, x, y, t, rx, ry);
        const Lanes dx = f.x[1] + t * (2 * f.x[2] + t * (3 * f.x[3])),
                    dy = f.y[1] + t * (2 * f.y[2] + t * (3 * f.y[3]));
        const Lanes d2x = 2 * f.x[2] + t * (6 * f.x[3]), d2y = 2 * f.y[2] + t * (6 * f.y[3]);
        const Lanes speed = dx * dx + dy * dy, slope = speed + (rx * d2x + ry * d2y);
        Lanes divisor = slope > .1F * speed ? slope : speed;
        active &= divisor > zero;
        divisor = divisor > zero ? divisor : one;
        Lanes moved = t - (rx * dx + ry * dy) / divisor;
        moved = moved < lo ? lo : moved;
        moved = moved > hi ? hi : moved;
        const Lanes step = moved - t;
        t = active ? moved : t;
        active &= step * step >= zero + kEnough * kEnough;
    }
}

TESSERA_INLINE void footOf(const LaneFeature& f, const Lanes& x, const Lanes& y, Lanes& t, Lanes& squared) {
    constexpr float kShare = 1.F / EdgeBlur::kSegments;
    Lanes start, distance;
    nearest(f.even ? f.base : f.chords[0], x, y, start, distance);
    if (!f.even)
        for (int k = 1; k < EdgeBlur::kSegments; ++k) {
            Lanes s, d;
            nearest(f.chords[k], x, y, s, d);
            start = d < distance ? s + float(k) : start;
            distance = d < distance ? d : distance;
        }
    if (!f.even) start *= kShare;
    t = start;
    refine(f, x, y, f.even ? float(EdgeBlur::kEvenSpan) : kShare, t);
    // Newton's method may leave for a worse place.
    Lanes offX, offY;
    offsetAt(f, x, y, start, offX, offY);
    const Lanes before = offX * offX + offY * offY;
    offsetAt(f, x, y, t, offX, offY);
    const Lanes after = offX * offX + offY * offY;
    t = before < after ? start : t;
    squared = before < after ? before : after;
}

// The points of `count` that are nearer to a segment than the square root of `limit`, in order, and how many:
// most vectors of points are out of reach as a whole. There are whole vectors of points.
TESSERA_VECTOR_CLONES size_t pointsWithin(const LaneSegment& segment, float limit, const float* x,
                                          const float* y, size_t count, uint16_t* found) {
    size_t length = 0;
    for (size_t first = 0; first < count; first += kVector) {
        Lanes px, py, s, d;
        load(x + first, px);
        load(y + first, py);
        nearest(segment, px, py, s, d);
        if (!any(d < Lanes{} + limit)) continue;
        for (size_t k = first; k < std::min(first + kVector, count); ++k) {
            const float squared = d[k - first];
            found[length] = uint16_t(k);
            length += size_t(squared < limit);
        }
    }
    return length;
}

// The least and the largest of whole vectors of values.
TESSERA_VECTOR_CLONES std::pair<float, float> extent(const float* values, size_t count) {
    Lanes lo, hi;
    load(values, lo);
    hi = lo;
    for (size_t i = kVector; i < count; i += kVector) {
        Lanes value;
        load(values + i, value);
        lo = value < lo ? value : lo;
        hi = value > hi ? value : hi;
    }
    float least = lo[0], largest = hi[0];
    for (size_t k = 1; k < kVector; ++k) {
        const float low = lo[k], high = hi[k];
        least = std::min(least, low);
        largest = std::max(largest, high);
    }
    return {least, largest};
}

// The nearest points of a feature.
TESSERA_VECTOR_CLONES void findFeet(const LaneFeature& f, const float* x, const float* y, size_t count,
                                    float* t, float* squared) {
    for (size_t i = 0; i < count; i += kVector) {
        Lanes px, py, foot, d;
        load(x + i, px);
        load(y + i, py);
        footOf(f, px, py, foot, d);
        store(foot, t + i);
        store(d, squared + i);
    }
}

// How many points whole vectors have.
constexpr size_t padded(size_t count) {
    return roundUp(count, kVector);
}

struct PointBox {
    glm::dvec2 lo, hi;
};

// The points nearest to one chain.
class ChainFeet {
  public:
    ChainFeet(glm::dvec2 origin, const float* x, const float* y, size_t count)
        : mOrigin(origin), mCount(count) {
        std::fill(std::copy_n(x, count, mX), mX + padded(count), x[0]);
        std::fill(std::copy_n(y, count, mY), mY + padded(count), y[0]);
        const auto [left, right] = extent(mX, padded(count));
        const auto [top, bottom] = extent(mY, padded(count));
        mBox = {origin + glm::dvec2(left, top), origin + glm::dvec2(right, bottom)};
    }

    // Looks at the reaches from `i` on that are of one chain, and sets i to the next chain's first; false
    // where all points are out of reach.
    bool search(const EdgeBlur& blur, std::span<const EdgeBlur::Reach> reaches, size_t& i) {
        const uint32_t chain = blur.features()[reaches[i].feature].chain;
        const double reach = blur.chains()[chain].reach;
        bool any = false;
        for (; i < reaches.size() && blur.features()[reaches[i].feature].chain == chain; ++i) {
            const EdgeBlur::Feature& f = blur.features()[reaches[i].feature];
            if (!collect(f, reach)) continue;
            if (!any) {
                std::fill_n(mSquared, mCount, float(reach * reach));
                std::fill_n(mNearest, mCount, kNone);
                any = true;
            }
            take(f, uint32_t(i));
        }
        return any;
    }

    // Calls body(point, its index among the reaches, foot) for each point that has one.
    template <class Body>
    void forEach(std::span<const EdgeBlur::Reach> reaches, Body&& body) const {
        for (size_t k = 0; k < mCount; ++k)
            if (mNearest[k] != kNone)
                body(k, reaches[mNearest[k]], EdgeBlur::Foot{mT[k], std::sqrt(double(mSquared[k]))});
    }

  private:
    static constexpr uint32_t kNone = 0xffffffff;

    // Sets mIndex to the points that may be within reach of the feature, wrong on the safe side.
    bool collect(const EdgeBlur::Feature& f, double reach) {
        const glm::dvec2 gap = glm::max(f.box.lo - mBox.hi, mBox.lo - f.box.hi);
        mFound = 0;
        if (std::max(gap.x, gap.y) > reach) return false;
        constexpr double kSlack = .01;  // px, more than the rounding of single precision
        const double limit = reach + f.bend + kSlack;
        const double away = limit + .5 * glm::distance(mBox.lo, mBox.hi);
        if (f.base.nearest(.5 * (mBox.lo + mBox.hi)).second > away * away) return false;
        mFound = pointsWithin(LaneSegment(f.base, mOrigin), float(limit * limit), mX, mY, mCount, mIndex);
        return mFound > 0;
    }

    // Takes the feature's nearest points where it is nearer than those before it.
    void take(const EdgeBlur::Feature& f, uint32_t reach) {
        for (size_t k = 0; k < padded(mFound); ++k) {
            const size_t point = mIndex[std::min(k, mFound - 1)];
            mFoundX[k] = mX[point];
            mFoundY[k] = mY[point];
        }
        findFeet(LaneFeature(f, mOrigin), mFoundX, mFoundY, padded(mFound), mFeetT, mFeetSquared);
        for (size_t k = 0; k < mFound; ++k) {
            const size_t point = mIndex[k];
            if (mFeetSquared[k] >= float(kNearer * kNearer) * mSquared[point]) continue;
            mSquared[point] = mFeetSquared[k];
            mT[point] = mFeetT[k];
            mNearest[point] = reach;
        }
    }

    glm::dvec2 mOrigin;
    size_t mCount;
    alignas(32) float mX[kMaxBlurPoints], mY[kMaxBlurPoints];
    PointBox mBox;
    // The points near the feature at hand, and their nearest on it.
    size_t mFound = 0;
    uint16_t mIndex[kMaxBlurPoints + 1];
    alignas(32) float mFoundX[kMaxBlurPoints], mFoundY[kMaxBlurPoints];
    alignas(32) float mFeetT[kMaxBlurPoints], mFeetSquared[kMaxBlurPoints];
    // Of each point: its foot so far.
    float mSquared[kMaxBlurPoints], mT[kMaxBlurPoints];
    uint32_t mNearest[kMaxBlurPoints];
};

// blurShare by a table, whose steps are small enough for straight lines between them to be within 1e-7 of it.
class ShareTable {
  public:
    ShareTable() {
        for (size_t i = 0; i < mShares.size(); ++i) mShares[i] = float(blurShare(double(i) / kPerSigma));
    }

    double operator()(double x) const {
        const auto place = float(x * kPerSigma);
        const auto i = std::min(size_t(place), mShares.size() - 2);
        return double(mShares[i] + (place - float(i)) * (mShares[i + 1] - mShares[i]));
    }

  private:
    static constexpr double kPerSigma = 512;
    std::array<float, size_t(kBlurReach* kPerSigma) + 1> mShares;
};

// Parts of points' colours: weight times a patch's at a place in its domain.
class Shares {
  public:
    void add(const BlurTerm& term, size_t point) {
        of(term.other).push_back({uint32_t(point), term.weight, term.otherAt});
        of(term.own).push_back({uint32_t(point), -term.weight, term.ownAt});
    }

    template <class Predicate>
    void removePoints(Predicate&& remove) {
        for (size_t i = 0; i < mPatches; ++i)
            std::erase_if(mByPatch[i].parts, [&](const Part& part) { return remove(part.point); });
    }

    // Adds the parts to the points' colours and forgets them: patch by patch for the vector code, by
    // ascending id, so that a point's come in an order of its own.
    void addTo(const PatchMesh& mesh, float* const* colours) {
        std::sort(mByPatch.begin(), mByPatch.begin() + std::ptrdiff_t(mPatches),
                  [](const OfPatch& a, const OfPatch& b) { return a.patch < b.patch; });
        for (size_t i = 0; i < mPatches; ++i) addParts(mesh, mByPatch[i].patch, mByPatch[i].parts, colours);
        mPatches = 0;
    }

  private:
    struct Part {
        uint32_t point;
        float weight;
        glm::vec2 at;
    };
    struct OfPatch {
        PatchId patch;
        std::vector<Part> parts;
    };

    // A chain's neighbouring points are mostly beside the same edge, so that few patches come, in turns.
    std::vector<Part>& of(PatchId patch) {
        for (size_t i = mPatches; i-- > 0;)
            if (mByPatch[i].patch == patch) return mByPatch[i].parts;
        if (mPatches == mByPatch.size()) mByPatch.emplace_back();
        OfPatch& fresh = mByPatch[mPatches++];
        fresh.patch = patch;
        fresh.parts.clear();
        return fresh.parts;
    }

    static void addParts(const PatchMesh& mesh, PatchId patch, std::span<const Part> parts,
                         float* const* colours) {
        constexpr size_t kBatch = 256;
        float x[kBatch], y[kBatch], value[kMaxChannels][kBatch];
        float* out[kMaxChannels];
        for (int c = 0; c < kMaxChannels; ++c) out[c] = value[c];
        for (; !parts.empty(); parts = parts.subspan(std::min(kBatch, parts.size()))) {
            const size_t n = std::min(kBatch, parts.size());
            for (size_t k = 0; k < n; ++k) {
                x[k] = parts[k].at.x;
                y[k] = parts[k].at.y;
            }
            evaluateSplines(mesh.spline(patch), mesh.channels(), x, y, n, out);
            for (int c = 0; c < mesh.channels(); ++c)
                for (size_t k = 0; k < n; ++k) colours[c][parts[k].point] += parts[k].weight * value[c][k];
        }
    }

    std::vector<OfPatch> mByPatch;  // the first mPatches are in use; the others keep their memory
    size_t mPatches = 0;
};

}  // namespace

void addBlur(const PatchMesh& mesh, const EdgeBlur& blur, PatchId p, glm::dvec2 origin, const float* x,
             const float* y, size_t count, float* const* colours) {
    TESSERA_CHECK(count <= kMaxBlurPoints);
    if (count == 0 || !blur.inReach(p)) return;
    const auto at = [&](size_t point) { return origin + glm::dvec2(x[point], y[point]); };
    const auto reaches = blur.reaches(p);
    ChainFeet feet(origin, x, y, count);
    static const ShareTable share;
    Shares shares;
    std::array<uint8_t, kMaxBlurPoints> terms{};
    bool tooMany = false;
    for (size_t i = 0; i < reaches.size();) {
        if (!feet.search(blur, reaches, i)) continue;
        feet.forEach(reaches, [&](size_t point, const EdgeBlur::Reach& reach, const EdgeBlur::Foot& foot) {
            BlurTerm term;
            if (!blur.termAt(p, reach, at(point), foot, term, share)) return;
            shares.add(term, point);
            if (terms[point] <= kMaxBlurTerms) ++terms[point];
            tooMany = tooMany || terms[point] > kMaxBlurTerms;
        });
    }
    if (tooMany) {  // hardly ever: the plain twin finds those that count
        shares.removePoints([&](uint32_t point) { return terms[point] > kMaxBlurTerms; });
        for (size_t k = 0; k < count; ++k) {
            if (terms[k] <= kMaxBlurTerms) continue;
            std::array<BlurTerm, kMaxBlurTerms> found;
            for (int i = 0, n = blur.terms(p, at(k), found); i < n; ++i) shares.add(found[size_t(i)], k);
        }
    }
    shares.addTo(mesh, colours);
}

}  // namespace tessera
