// The initial channel meshes (paper section 4.1, Figs. 3 and 4): the pixel grid, triangulated, with subpixels
// inserted along features and split into dual vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/halfedge_mesh.h"
#include "core/mesh/lattice.h"
#include "core/vectorize/features.h"

namespace tessera {

// What a vertex may do in the simplification (section 4.2, item 3).
enum class VertexKind : uint8_t {
    Interior,
    Feature,     // inside a feature curve: one pair of dual vertices
    FeatureEnd,  // a tip, or where several features meet: stays
    Border,      // on a side of the picture: slides along it
    Corner,      // of the picture: stays
};
constexpr int kVertexKinds = 5;

// A part of a feature as the simplification sees it: the vertices from..to (in steps of one, wrapping where
// the chain is closed) of a chain of subpixels.
struct ChainPart {
    uint32_t chain = 0;
    uint32_t from = 0;
    uint32_t to = 0;
};

// A chain of subpixels: the original polyline of a feature. A closed one does not repeat its first vertex.
struct SubpixelChain {
    std::vector<VertexId> vertices;
    bool closed = false;
};

// All channel meshes at once: they share connectivity and (x, y) and differ in their heights alone. Where the
// paper cuts the meshes open along features, the connectivity here stays whole, and a vertex on a feature has
// several COPIES instead: one for each sector of faces between features. A dual pair is two copies; a
// junction would have more.
struct ChannelMeshes {
    int width = 0;
    int height = 0;
    int channels = 0;
    HalfedgeMesh mesh;
    std::vector<LatticePoint> positions;  // by vertex
    std::vector<VertexKind> kinds;        // by vertex
    // By halfedge: the copy of its origin that the corner of its face belongs to. Copies 0 .. vertexCount - 1
    // are the vertices' own (for a feature, that on the positive side of the chain); the rest are further
    // copies.
    std::vector<uint32_t> copyOfCorner;
    std::vector<float> heights;  // by copy, `channels` values each: the colour, 0..1
    std::vector<SubpixelChain> chains;
    std::vector<int32_t> partOfEdge;  // by edge: index into parts, or -1 where it is no feature
    std::vector<ChainPart> parts;     // in the direction of the chain

    size_t copyCount() const { return heights.size() / size_t(channels); }
    const float* heightsOf(uint32_t copy) const { return heights.data() + size_t(copy) * size_t(channels); }
    bool isFeature(EdgeId e) const { return partOfEdge[e.index] >= 0; }
};

// Builds the meshes over [0, W] x [0, H]: pixel centres at +.5, and a ring half a pixel out that carries the
// colours of the nearest pixels. With settings.fairingRadiusPx > 0, heights near features are faired (Taubin
// 1995), each copy with neighbours on its own side.
Result<ChannelMeshes> buildInitialMesh(const Image& image, const std::vector<PixelChain>& features,
                                       const VectorizeSettings& settings, StageReport& report,
                                       Progress& progress);

}  // namespace tessera
