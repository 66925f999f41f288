// The mesh on the GPU: geometry and splines by id, and the index of blurred features. The buffers mirror the
// model, so that what an edit costs follows the patches that it touches, and they know nothing of the view.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/mesh/edge_blur.h"
#include "core/mesh/patch_mesh.h"
#include "core/mesh/view.h"
#include "render/gpu_layout.h"
#include "render/mirror_buffer.h"

namespace tessera::render {

// The places of the splines' terms in their buffer: each patch has a run with room to spare, and runs that
// are given back are used again for others of the same room.
class TermHeap {
  public:
    struct Run {
        uint32_t first = 0;
        uint32_t room = 0;
    };
    // A run with room for `count` terms; `run` itself where it has that.
    Run fit(Run run, uint32_t count);
    // The buffer's size that all runs fit in.
    size_t size() const { return mSize; }
    void clear();

  private:
    size_t mSize = 0;
    std::map<uint32_t, std::vector<uint32_t>> mFree;  // firsts by room
};

class PatchBuffers {
  public:
    // The whole mesh, and its blur times `sharpen` (0: no index of the features).
    void setMesh(const PatchMesh& mesh, double sharpen);
    // What belongs to these patches: their control points, those on their sides included, their splines, and
    // the features of the whole mesh where a side has moved or changed its blur. Connectivity is as it was.
    void update(const PatchMesh& mesh, std::span<const PatchId> patches, double sharpen);
    // The features alone, with another `sharpen`.
    void setBlur(const PatchMesh& mesh, double sharpen);

    // Sends what has changed; returns how many bytes. Needs the context.
    size_t upload();
    // Binds the buffers to their binding points.
    void bind() const;

    size_t patchCount() const { return mPatches.size(); }
    size_t edgeCount() const { return mEdges.size(); }

  private:
    bool setEdge(const PatchMesh& mesh, EdgeId e);
    void setPatch(const PatchMesh& mesh, PatchId p);
    void setSpline(const PatchMesh& mesh, PatchId p, GpuPatch& patch);

    MirrorBuffer<GpuEdge> mEdges{GL_RGBA32I};
    MirrorBuffer<GpuPatch> mPatches{GL_RGBA32UI};
    MirrorBuffer<GpuTerm> mTerms{GL_RGBA32F};
    MirrorBuffer<GpuReachList> mReachLists{GL_RG32UI};
    MirrorBuffer<uint32_t> mReaches{GL_R32UI};
    MirrorBuffer<GpuFeature> mFeatures{GL_RGBA32UI};
    TermHeap mHeap;
    std::vector<TermHeap::Run> mRuns;           // by patch id
    std::vector<std::array<float, 2>> mSigmas;  // by edge id; -1 where the edge is no feature
};

// The view as the shaders see it, `samplesPerSide` of them along each side of a pixel; (targetX, targetY) is
// the lower left pixel of where it is drawn. Counts of elements are left 0.
GpuView gpuView(const PatchMesh& mesh, const View& view, int samplesPerSide, glm::ivec2 target);

}  // namespace tessera::render
