// Soft features: the colour near a blurred feature curve, derived from the two patches beside it
// (blur_profile.h; COLOUR.md says how it adds up).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/blur_profile.h"
#include "core/mesh/patch_mesh.h"

namespace tessera {

// A point's colour is its own patch's plus, for each term, weight * (other(otherAt) - own(ownAt)): the jump
// of the feature nearby, taken at the nearest point on it.
struct BlurTerm {
    float weight = 0;    // 0 .. 1/2
    PatchId own, other;  // beside the feature, on the point's side and beyond
    glm::vec2 ownAt{0};  // that nearest point, in the parametric domains of both
    glm::vec2 otherAt{0};
};

constexpr int kMaxBlurTerms = 4;

// Of a chain's features a later one is a point's nearest only where it is nearer by this factor: beside a
// bend two share the vertex as their nearest point, and rounding must not choose between them.
constexpr double kNearer = 1 - 1.0 / 2048;

// An index over the blurred features of one state of a mesh. A chain of features (a run of feature edges
// through vertices that have two of them) gives a point at most one term.
class EdgeBlur {
  public:
    // `sharpen` >= 0 multiplies every blurSigma; 0 makes all features hard. Keeps nothing of the mesh.
    explicit EdgeBlur(const PatchMesh& mesh, double sharpen = 1);

    // Whether any point of the patch may have terms.
    bool inReach(PatchId p) const { return !mFirst.empty() && mFirst[p.index] != mFirst[p.index + 1]; }

    // How much of the jump across an edge is blurred on the edge itself, at parameter t of its curve: 1 but
    // near a free tip or a junction; 0 where the edge has no blur.
    double strength(EdgeId e, double t) const;

    // The terms at image point `at` of patch p, in an order that depends on nothing else; returns how many.
    // Where more than kMaxBlurTerms chains are near, those of the largest weights. Thread-safe.
    int terms(PatchId p, glm::dvec2 at, std::array<BlurTerm, kMaxBlurTerms>& out) const;

    // What the index holds, for a renderer that computes terms by itself. Features lie chain after chain.
    static constexpr int kSegments = 8;
    struct Box {
        glm::dvec2 lo, hi;
    };
    struct Segment {
        glm::dvec2 from{0}, along{0};
        double inverse = 0;  // 1 / |along|^2; 0 for a point

        Segment() = default;
        Segment(glm::dvec2 a, glm::dvec2 b);
        // The nearest point's share of `along`, and the square of its distance.
        std::pair<double, double> nearest(glm::dvec2 at) const;
    };
    // A feature edge, in the direction of its chain.
    struct Feature {
        HalfedgeId halfedge;
        uint32_t chain = 0;
        BezierCurve curve;
        Box box;                                  // of the curve
        std::array<double, 2> sigma{};            // px, sharpen included, at both ends
        std::array<glm::dvec2, 2> endTangents{};  // the chain's, where two edges meet the mean of theirs
        std::array<PatchId, 2> patches;           // left, where cross(tangent, to the point) > 0; right
        std::array<uint8_t, 2> sides{};           // which side of the patch the edge is
        Segment base;                             // from end to end
        double bend = 0;                          // the curve's distance from the base, at most
        bool even = false;                        // t is nearly the share of the base
        std::array<Segment, kSegments> chords;    // between the points at t = i / kSegments
        std::array<double, kSegments + 1> arc{};  // px along the chain
        double flatness = 0;                      // its distance from the chords, at most

        double sigmaAt(double t) const { return sigma[0] + t * (sigma[1] - sigma[0]); }
        double arcAt(double t) const;
        glm::vec2 domainAt(int side, double t) const;
    };
    struct Chain {
        double length = 0;  // px
        double reach = 0;   // px
        bool fadesAtBegin = false, fadesAtEnd = false;
    };
    // A feature within reach of a patch, and from which of its sides the patch is reached.
    struct Reach {
        uint32_t feature = 0;
        uint8_t sides = 0;  // bit 0: from the left, bit 1: from the right
    };
    std::span<const Feature> features() const { return mFeatures; }
    std::span<const Chain> chains() const { return mChains; }
    // Of patch p, in the order of features().
    std::span<const Reach> reaches(PatchId p) const {
        if (!inReach(p)) return {};
        return std::span(mReaches).subspan(mFirst[p.index], mFirst[p.index + 1] - mFirst[p.index]);
    }

    // A point's nearest on a feature.
    struct Foot {
        double t = 0;
        double distance = 0;  // px
    };
    // Where the nearest parameter of even features is sought: this far from the share of the base.
    static constexpr double kEvenSpan = .3;
    // Sets `term` to that of `at` in patch p, whose nearest point on a chain is `foot`; false where it has
    // none. share(x) is blurShare(x) for 0 <= x < kBlurReach, or as good.
    template <class Share>
    bool termAt(PatchId p, const Reach& reach, glm::dvec2 at, const Foot& foot, BlurTerm& term,
                Share&& share) const {
        const Feature& f = mFeatures[reach.feature];
        const double sigma = f.sigmaAt(foot.t);
        if (sigma <= 0 || foot.distance >= kBlurReach * sigma) return false;
        const double weight = share(foot.distance / sigma) * fade(f, foot.t, sigma);
        if (weight <= 0) return false;
        const int own = sideOf(f, reach, p, at, foot.t);
        term = {float(weight), f.patches[size_t(own)], f.patches[size_t(1 - own)], f.domainAt(own, foot.t),
                f.domainAt(1 - own, foot.t)};
        return true;
    }

  private:
    static constexpr uint32_t kNone = 0xffffffff;

    double fade(const Feature& feature, double t, double sigma) const;
    void collectChains(const PatchMesh& mesh, double sharpen);
    void addChain(const PatchMesh& mesh, const std::vector<HalfedgeId>& run, bool closed, double sharpen,
                  const std::vector<uint8_t>& featuresAt);
    void joinTangents(size_t first, bool closed);
    void collectReaches(const PatchMesh& mesh);
    static bool findFoot(const Feature& feature, glm::dvec2 at, Foot& foot);
    static int sideOf(const Feature& feature, const Reach& reach, PatchId p, glm::dvec2 at, double t);

    std::vector<Feature> mFeatures;
    std::vector<Chain> mChains;
    std::vector<uint32_t> mFeatureOf;  // by edge id; kNone where the edge is no feature
    std::vector<uint32_t> mFirst;      // by patch id, into mReaches; empty where nothing is blurred
    std::vector<Reach> mReaches;       // of each patch in the order of mFeatures
};

// The index of one geometry: what was made for a mesh serves its copies, and those whose colours alone have
// changed, until one with another geometry asks. Thread-safe.
class EdgeBlurCache {
  public:
    std::shared_ptr<const EdgeBlur> get(const PatchMesh& mesh, double sharpen);

  private:
    std::mutex mMutex;  // held while an index is made, so that it is made once
    MeshGeometry mGeometry;
    double mSharpen = 1;
    std::shared_ptr<const EdgeBlur> mBlur;  // of both; or none yet
};

// An EdgeBlur of the mesh, from its cache where that has it.
std::shared_ptr<const EdgeBlur> edgeBlurOf(const PatchMesh& mesh, double sharpen = 1);

// The colour of patch p in the mesh's basis at parameters `at`, whose image point is `point`: what renderers
// show, in double precision. Sets out[channel].
void blurredColour(const PatchMesh& mesh, const EdgeBlur& blur, PatchId p, const Barycentric& at,
                   glm::dvec2 point, double* out);

// Adds the terms of the image points origin + (x[i], y[i]) of patch p to its own colours there, channel by
// channel: the fast twin of blurredColour, in single precision. A point's colour does not depend on its
// neighbours, to the last bit. At most kMaxBlurPoints points. (edge_blur_simd.cpp)
constexpr size_t kMaxBlurPoints = 512;
void addBlur(const PatchMesh& mesh, const EdgeBlur& blur, PatchId p, glm::dvec2 origin, const float* x,
             const float* y, size_t count, float* const* colours);

}  // namespace tessera
