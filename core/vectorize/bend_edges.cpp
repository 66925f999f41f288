// See bend_edges.h.
#include "core/vectorize/bend_edges.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/mesh/jacobian.h"
#include "core/vectorize/fit_curves.h"
#include "core/vectorize/parameter_fit.h"

namespace tessera {

namespace {

constexpr int kRounds = 2;
// What an edge must save: a part of its two patches' error, and one level of one pixel and channel.
constexpr double kLeastGain = .03;
constexpr double kLeastSaving = 1.0 / (255.0 * 255.0);

// How far an edge's inner control points lie beside those of the straight edge, to the left of it in the
// direction of its halfedge; in lengths of the chord.
struct Bend {
    double first = 0;
    double second = 0;

    bool operator==(const Bend&) const = default;
};

// 0 also where the base triangle is not positive.
double evenness(const LatticeTriangle& t) {
    if (cross(t.corner(1) - t.corner(0), t.corner(2) - t.corner(0)) <= 0) return 0;
    const auto coefficients = jacobianBernstein(t);
    double least = coefficients[0], sum = 0;
    for (const double c : coefficients) {
        least = std::min(least, c);
        sum += c;
    }
    return least > 0 ? least * double(coefficients.size()) / sum : 0;
}

// Of an edge's cubic, in the direction of its halfedge.
using InnerPoints = std::array<LatticePoint, 2>;

class EdgeBender {
  public:
    EdgeBender(PatchMesh mesh, const ParameterFit& fit);

    bool measure(const Progress& progress);
    bool bend(Progress& progress, StageReport& report);
    PatchMesh takeMesh();

  private:
    // An edge's curve, and its two patches with it.
    struct Candidate {
        Bend bend;
        InnerPoints curve;
        std::array<LatticePoint, 2> interiors;
        std::array<double, 2> errors{};

        double error() const { return errors[0] + errors[1]; }
    };

    std::array<PatchId, 2> patchesOf(EdgeId e) const;
    InnerPoints curveOf(EdgeId e, Bend bend) const;
    // Of a patch with `curve` in the place of edge e's own.
    LatticeTriangle controlPoints(PatchId p, EdgeId e, const InnerPoints& curve) const;
    std::optional<LatticePoint> goodInterior(PatchId p, EdgeId e, const InnerPoints& curve) const;
    void improve(EdgeId e, Bend bend, Candidate& best) const;
    bool bendEdge(EdgeId e, int round);
    double totalError() const;

    PatchMesh mMesh;
    const ParameterFit& mFit;
    std::vector<EdgeId> mFree;
    std::vector<InnerPoints> mCurves;      // by edge
    std::vector<Bend> mBends;              // by edge
    std::vector<LatticePoint> mInteriors;  // by patch
    std::vector<double> mErrors;           // by patch
};

EdgeBender::EdgeBender(PatchMesh mesh, const ParameterFit& fit)
    : mMesh(std::move(mesh)),
      mFit(fit),
      mCurves(mMesh.connectivity().edgeCapacity()),
      mBends(mCurves.size()),
      mInteriors(mMesh.connectivity().faceCapacity()),
      mErrors(mInteriors.size()) {
    mMesh.forEachEdge([&](EdgeId e) {
        const auto control = mMesh.controlPoints(HalfedgeMesh::halfedge(e));
        mCurves[e.index] = {control[1], control[2]};
        if (!mMesh.curve(e).feature && !mMesh.connectivity().onBorder(e)) mFree.push_back(e);
    });
    mMesh.forEachPatch([&](PatchId p) { mInteriors[p.index] = mMesh.interior(p); });
}

bool EdgeBender::measure(const Progress& progress) {
    parallelFor(mErrors.size(), 16, [&](size_t begin, size_t end) {
        for (auto p = uint32_t(begin); p < end && !progress.stopRequested(); ++p)
            if (mMesh.connectivity().alive(PatchId(p)))
                mErrors[p] = mFit.error(mMesh.controlPoints(PatchId(p)));
    });
    return !progress.stopRequested();
}

std::array<PatchId, 2> EdgeBender::patchesOf(EdgeId e) const {
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    return {mMesh.connectivity().face(h), mMesh.connectivity().face(HalfedgeMesh::twin(h))};
}

InnerPoints EdgeBender::curveOf(EdgeId e, Bend bend) const {
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    const LatticePoint a = mMesh.position(mMesh.connectivity().origin(h)),
                       b = mMesh.position(mMesh.connectivity().target(h));
    const auto inner = straightControlPoints(a, b);
    const glm::dvec2 chord = toPixels(b - a), left(-chord.y, chord.x);
    return {inner[0] + toLattice(bend.first * left), inner[1] + toLattice(bend.second * left)};
}

LatticeTriangle EdgeBender::controlPoints(PatchId p, EdgeId e, const InnerPoints& curve) const {
    const HalfedgeMesh& c = mMesh.connectivity();
    LatticeTriangle t;
    size_t i = 0;
    for (const HalfedgeId side : c.sides(p)) {
        const EdgeId edge = HalfedgeMesh::edge(side);
        const auto& inner = edge == e ? curve : mCurves[edge.index];
        const bool along = side == HalfedgeMesh::halfedge(edge);
        t.p[i++] = mMesh.position(c.origin(side));
        t.p[i++] = inner[along ? 0 : 1];
        t.p[i++] = inner[along ? 1 : 0];
    }
    t.p[kInterior] = mInteriors[p.index];
    return t;
}

void EdgeBender::improve(EdgeId e, Bend bend, Candidate& best) const {
    Candidate trial{bend, curveOf(e, bend), {}, {}};
    const auto patches = patchesOf(e);
    std::array<LatticeTriangle, 2> shapes;
    for (size_t i = 0; i < 2; ++i) {
        LatticeTriangle& t = shapes[i];
        t = controlPoints(patches[i], e, trial.curve);
        trial.interiors[i] = t.p[kInterior] = toLattice(defaultInterior(toPixels(t)));
        if (evenness(t) < kLeastEvenness || !certified(t)) return;
    }
    for (size_t i = 0; i < 2; ++i) {
        trial.errors[i] = mFit.error(shapes[i]);
        if (trial.error() >= best.error()) return;
    }
    best = trial;
}

bool EdgeBender::bendEdge(EdgeId e, int round) {
    const auto [first, second] = patchesOf(e);
    const Candidate now{mBends[e.index],
                        mCurves[e.index],
                        {mInteriors[first.index], mInteriors[second.index]},
                        {mErrors[first.index], mErrors[second.index]}};
    Candidate best = now;
    constexpr double kArcs[] = {-.04, .04, -.1, .1, -.18, .18};
    if (round == 0)
        for (const double h : kArcs) improve(e, {h, h}, best);
    for (double step = .04; step > .005; step *= .5) {
        const Bend from = best.bend;
        for (const auto& [a, b] : {std::pair{1, 1}, {-1, -1}, {1, -1}, {-1, 1}})
            improve(e, {from.first + a * step, from.second + b * step}, best);
    }
    if (now.error() - best.error() <= kLeastGain * now.error() + kLeastSaving) return false;
    mBends[e.index] = best.bend;
    mCurves[e.index] = best.curve;
    mInteriors[first.index] = best.interiors[0];
    mInteriors[second.index] = best.interiors[1];
    mErrors[first.index] = best.errors[0];
    mErrors[second.index] = best.errors[1];
    return true;
}

double EdgeBender::totalError() const {
    double sum = 0;
    mMesh.forEachPatch([&](PatchId p) { sum += mErrors[p.index]; });
    return sum;
}

bool EdgeBender::bend(Progress& progress, StageReport& report) {
    const auto classes = colourEdges(mMesh.connectivity(), mFree);
    const double before = totalError();
    std::vector<uint8_t> bent(mCurves.size(), 1);
    std::atomic<size_t> done{0};
    std::atomic<bool> stop{false};
    // An edge is worth another try where something around it changed in the round before or since.
    const auto disturbed = [&](EdgeId e) {
        for (const PatchId p : patchesOf(e))
            for (const HalfedgeId side : mMesh.connectivity().sides(p))
                if (bent[HalfedgeMesh::edge(side).index]) return true;
        return false;
    };
    for (int round = 0; round < kRounds; ++round)
        for (const auto& edges : classes) {
            parallelFor(edges.size(), 8, [&](size_t begin, size_t end) {
                for (size_t i = begin; i < end && !stop; ++i) {
                    const double fraction = double(done++) / double(mFree.size() * kRounds);
                    if (!progress.step(fraction)) stop = true;
                    bent[edges[i].index] = disturbed(edges[i]) && bendEdge(edges[i], round);
                }
            });
            if (stop) return false;
        }
    const auto curved =
        std::count_if(mFree.begin(), mFree.end(), [&](EdgeId e) { return mBends[e.index] != Bend{}; });
    report.figures.emplace_back("curved edges", double(curved));
    report.figures.emplace_back("edges", double(mFree.size()));
    report.figures.emplace_back("error before", before);
    report.figures.emplace_back("error after", totalError());
    return true;
}

PatchMesh EdgeBender::takeMesh() {
    for (const EdgeId e : mFree)
        mMesh.setInnerControlPoints(HalfedgeMesh::halfedge(e), mCurves[e.index][0], mCurves[e.index][1]);
    for (uint32_t p = 0; p < mInteriors.size(); ++p)
        if (mMesh.connectivity().alive(PatchId(p))) mMesh.setInterior(PatchId(p), mInteriors[p]);
    return std::move(mMesh);
}

}  // namespace

Result<PatchMesh> bendEdges(PatchMesh mesh, const Image& picture, StageReport& report, Progress& progress) {
    const ParameterFit fit(picture, progress.stopToken());
    EdgeBender bender(std::move(mesh), fit);
    if (!bender.measure(progress) || !bender.bend(progress, report)) return stopped();
    return bender.takeMesh();
}

}  // namespace tessera
