// See patch_buffers.h.
#include "render/patch_buffers.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/round_up.h"

namespace tessera::render {

namespace {

glm::ivec2 toGpu(LatticePoint p) {
    return {p.x, p.y};
}

// Whether the control points are those of the straight triangle, up to the rounding to the lattice.
bool affine(const LatticeTriangle& t) {
    for (int i = 0; i <= 3; ++i)
        for (int j = 0; i + j <= 3; ++j) {
            const int k = 3 - i - j;
            const LatticePoint p = t.p[size_t(controlIndex(i, j, k))];
            const auto off = [&](auto member) {
                return std::abs(int64_t(3) * p.*member - int64_t(i) * t.p[0].*member -
                                int64_t(j) * t.p[3].*member - int64_t(k) * t.p[6].*member);
            };
            if (std::max(off(&LatticePoint::x), off(&LatticePoint::y)) > 3) return false;
        }
    return true;
}

GpuFeature gpuFeature(const PatchMesh& mesh, const EdgeBlur::Feature& f, const EdgeBlur::Chain& chain) {
    GpuFeature result{};
    const auto control = mesh.controlPoints(f.halfedge);
    result.ends = {toGpu(control[0]), toGpu(control[3])};
    result.inner = {toGpu(control[1]), toGpu(control[2])};
    for (size_t i = 0; i < 2; ++i) {
        result.endTangents[i] = glm::vec2(f.endTangents[i]);
        result.sigma[i] = float(f.sigma[i]);
        result.patches[i] = f.patches[i].index;
    }
    result.bend = float(f.bend);
    result.flatness = float(f.flatness);
    result.chain = f.chain;
    result.reach = float(chain.reach);
    result.chainLength = float(chain.length);
    result.flags = (f.even ? kGpuEven : 0) | (chain.fadesAtBegin ? kGpuFadesAtBegin : 0) |
                   (chain.fadesAtEnd ? kGpuFadesAtEnd : 0) | uint32_t(f.sides[0]) << kGpuSideShift |
                   uint32_t(f.sides[1]) << (kGpuSideShift + 2);
    for (size_t i = 0; i <= kGpuFeatureSegments; ++i) result.arc[i] = float(f.arc[i]);
    for (size_t i = 0; i < kGpuFeatureSegments; ++i)
        result.chords[i] = glm::vec2(f.chords[i].from + f.chords[i].along - f.curve.p[0]);
    return result;
}

}  // namespace

TermHeap::Run TermHeap::fit(Run run, uint32_t count) {
    if (count <= run.room) return run;
    // A few more than asked for, since refits change the number by a few.
    constexpr uint32_t kStep = 4;
    const uint32_t room = roundUp(count, kStep);
    if (run.room > 0) mFree[run.room].push_back(run.first);
    std::vector<uint32_t>& same = mFree[room];
    if (!same.empty()) {
        const uint32_t first = same.back();
        same.pop_back();
        return {first, room};
    }
    mSize += room;
    return {uint32_t(mSize - room), room};
}

void TermHeap::clear() {
    mSize = 0;
    mFree.clear();
}

void PatchBuffers::setMesh(const PatchMesh& mesh, double sharpen) {
    const HalfedgeMesh& c = mesh.connectivity();
    mEdges.resize(c.edgeCapacity());
    mPatches.resize(c.faceCapacity());
    mSigmas.assign(c.edgeCapacity(), {-1, -1});
    mRuns.assign(c.faceCapacity(), {});
    mHeap.clear();
    mesh.forEachEdge([&](EdgeId e) { setEdge(mesh, e); });
    for (uint32_t i = 0; i < c.faceCapacity(); ++i)
        if (c.alive(PatchId(i)))
            setPatch(mesh, PatchId(i));
        else
            mPatches.set(i, {});
    setBlur(mesh, sharpen);
}

void PatchBuffers::update(const PatchMesh& mesh, std::span<const PatchId> patches, double sharpen) {
    const HalfedgeMesh& c = mesh.connectivity();
    TESSERA_CHECK(c.faceCapacity() == mPatches.size() && c.edgeCapacity() == mEdges.size());
    bool moved = false;
    for (const PatchId p : patches) {
        for (const HalfedgeId h : c.sides(p)) moved = setEdge(mesh, HalfedgeMesh::edge(h)) || moved;
        setPatch(mesh, p);
    }
    if (moved) setBlur(mesh, sharpen);
}

bool PatchBuffers::setEdge(const PatchMesh& mesh, EdgeId e) {
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    const auto control = mesh.controlPoints(h);
    GpuEdge edge;
    for (size_t i = 0; i < control.size(); ++i) edge.p[i] = toGpu(control[i]);
    const EdgeCurve& curve = mesh.curve(e);
    const std::array<float, 2> sigma = curve.feature ? curve.blurSigma : std::array<float, 2>{-1, -1};
    const bool moved = edge.p != mEdges[e.index].p || sigma != mSigmas[e.index];
    mEdges.set(e.index, edge);
    mSigmas[e.index] = sigma;
    return moved;
}

void PatchBuffers::setPatch(const PatchMesh& mesh, PatchId p) {
    const HalfedgeMesh& c = mesh.connectivity();
    GpuPatch patch{};
    const auto sides = c.sides(p);
    for (size_t i = 0; i < sides.size(); ++i) patch.sides[i] = sides[i].index;
    const PatchAttributes& attributes = mesh.attributes(p);
    patch.flags = (attributes.cutOut ? 0 : kGpuDrawn) | (attributes.hidden ? kGpuHidden : 0) |
                  (affine(mesh.controlPoints(p)) ? kGpuAffine : 0);
    patch.interior = toGpu(mesh.interior(p));
    setSpline(mesh, p, patch);
    mPatches.set(p.index, patch);
}

void PatchBuffers::setSpline(const PatchMesh& mesh, PatchId p, GpuPatch& patch) {
    const PatchSpline& spline = mesh.spline(p);
    const int channels = mesh.channels();
    const auto count = uint32_t(spline.maxTerms(channels));
    TermHeap::Run& run = mRuns[p.index];
    run = mHeap.fit(run, count);
    if (mHeap.size() > mTerms.size()) mTerms.resize(std::max(mHeap.size(), mTerms.size() * 5 / 4));
    uint32_t others = 0;
    std::vector<GpuTerm> terms(count);
    for (uint32_t i = 0; i < count; ++i) terms[i] = {glm::vec2(spline.centre(int(i))), {}, {}};
    for (int ch = 0; ch < channels; ++ch) {
        const size_t first = spline.offset(ch);
        for (size_t row = 0; row < 3; ++row) patch.polynomial[row][ch] = spline.coefficients[first + row];
        const uint32_t n = spline.terms[size_t(ch)];
        for (uint32_t i = 0; i < n; ++i) terms[i].alpha[size_t(ch)] = spline.coefficients[first + 3 + i];
        if (ch > 0) others = std::max(others, n);
    }
    for (uint32_t i = 0; i < count; ++i) mTerms.set(run.first + i, terms[i]);
    patch.firstTerm = run.first;
    patch.terms = count | others << 16;
}

void PatchBuffers::setBlur(const PatchMesh& mesh, double sharpen) {
    const std::shared_ptr<const EdgeBlur> blur = edgeBlurOf(mesh, sharpen);
    const auto features = blur->features();
    const auto chains = blur->chains();
    mFeatures.resize(features.size());
    for (size_t i = 0; i < features.size(); ++i)
        mFeatures.set(i, gpuFeature(mesh, features[i], chains[features[i].chain]));

    // Reaches in runs with room to spare, so that a patch that is reached by one more moves no other's.
    mReachLists.resize(mPatches.size());
    TermHeap heap;
    for (uint32_t p = 0; p < mPatches.size(); ++p) {
        const auto reaches = blur->reaches(PatchId(p));
        const TermHeap::Run run = heap.fit({}, uint32_t(reaches.size()));
        if (heap.size() > mReaches.size()) mReaches.resize(std::max(heap.size(), mReaches.size() * 5 / 4));
        for (size_t k = 0; k < reaches.size(); ++k)
            mReaches.set(run.first + k, reaches[k].feature | (reaches[k].sides & 1 ? kGpuReachFromLeft : 0) |
                                            (reaches[k].sides & 2 ? kGpuReachFromRight : 0));
        mReachLists.set(p, {run.first, uint32_t(reaches.size())});
    }
}

size_t PatchBuffers::upload() {
    return mEdges.upload() + mPatches.upload() + mTerms.upload() + mReachLists.upload() + mReaches.upload() +
           mFeatures.upload();
}

void PatchBuffers::bind() const {
    mEdges.bind(Unit::Edges);
    mPatches.bind(Unit::Patches);
    mTerms.bind(Unit::Terms);
    mReachLists.bind(Unit::ReachLists);
    mReaches.bind(Unit::Reaches);
    mFeatures.bind(Unit::Features);
}

GpuView gpuView(const PatchMesh& mesh, const View& view, int samplesPerSide, glm::ivec2 target) {
    // Farther off nothing of a picture is in view, and the differences stay in 32 bits.
    constexpr double kFarthest = 1 << 29;
    // Output pixels: a sixty-fourth is seen by few pixel centres; the resolve pass mends the parameters.
    constexpr double kEdgeTolerance = 1.0 / 64, kInsideTolerance = 1.0 / 4;
    GpuView result{};
    for (int i = 0; i < 2; ++i) {
        const double origin = std::clamp(view.origin[i] * kLatticePerPixel, -kFarthest, kFarthest);
        result.origin[i] = int32_t(std::floor(origin));
        result.fraction[i] = float(origin - std::floor(origin));
        result.gridPerUnit[i] = float(view.scale[i] * samplesPerSide / kLatticePerPixel);
    }
    result.gridSize = {view.width * samplesPerSide, view.height * samplesPerSide};
    result.target = target;
    result.edgeTolerance = float(kEdgeTolerance * samplesPerSide);
    result.insideTolerance = float(kInsideTolerance * samplesPerSide);
    result.opponent = mesh.colourBasis() == ColourBasis::Opponent;
    result.channels = uint32_t(mesh.channels());
    return result;
}

}  // namespace tessera::render
