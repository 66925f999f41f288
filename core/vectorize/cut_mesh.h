// The triangulation that the default method works on: straight edges, and cubic ones along features, over a
// picture whose features have been cut out of their blur.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/halfedge_mesh.h"
#include "core/mesh/lattice.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/feature_network.h"
#include "core/vectorize/initial_mesh.h"
#include "core/vectorize/settings.h"

namespace tessera {

// A feature edge: the points first..last of a chain (wrapping where it is closed) as one cubic.
struct CutCurve {
    VertexId from, to;
    uint32_t chain = 0, first = 0, last = 0;
    std::array<LatticePoint, 2> inner;
    std::array<float, 2> sigma{};  // of the blur at both ends, px

    // The four control points from vertex `a`, which is one of the ends.
    std::array<LatticePoint, 4> controlPoints(VertexId a, const std::vector<LatticePoint>& positions) const;
};

// Every face has a certified interior point, with its curved sides and with chords in place of them.
struct CutMesh {
    int width = 0, height = 0;  // px
    HalfedgeMesh mesh;
    std::vector<LatticePoint> positions;  // by vertex
    std::vector<VertexKind> kinds;        // by vertex
    std::vector<FeatureChain> chains;
    std::vector<CutCurve> curves;
    std::vector<int32_t> curveOfEdge;  // by edge: into curves, or -1 (also beyond the array's end)

    const CutCurve* curve(EdgeId e) const {
        return e.index < curveOfEdge.size() && curveOfEdge[e.index] >= 0
                   ? &curves[size_t(curveOfEdge[e.index])]
                   : nullptr;
    }
};

// Stage "initial-mesh", variant "delaunay": the constrained Delaunay triangulation of the network's nodes and
// of points as dense as `sharp` is rich (error diffusion, Yang et al. 2003), about `faces` triangles.
// Segments whose curves leave a patch beside them without a certificate are halved, and pulled toward their
// chords where that does not help. Points of faces too thin for a certificate are left out, and segments
// where their nodes alone make such a face.
Result<CutMesh> buildCutMesh(const Image& sharp, const FeatureNetwork& network, size_t faces,
                             const VectorizeSettings& settings, StageReport& report, Progress& progress);

// The nine control points of a face's sides, as its patch has them; the interior point is left at 0.
LatticeTriangle sideControlPoints(const CutMesh& cut, FaceId f);

// The patches: interior points certified, features marked with their blur, colours constant.
PatchMesh toPatchMesh(const CutMesh& cut, int channels);

}  // namespace tessera
