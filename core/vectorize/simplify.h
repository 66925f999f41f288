// Base domain computation (paper section 4.2): one synchronized sequence of half-edge collapses over all
// channel meshes, by the quadric error summed over channels, that keeps features.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/initial_mesh.h"

namespace tessera {

// The projection of the coarse meshes: straight triangles, but for the curves that features were fitted with.
// Every patch is certified as it stands.
struct BaseDomain {
    PatchMesh mesh;
    // By edge, along HalfedgeMesh::halfedge(edge), ends included, in pixels: for a feature its original
    // polyline, for another edge the path through the vertices that it absorbed, pruned of branches and
    // loops.
    std::vector<std::vector<glm::dvec2>> paths;
};

// Where each kind of vertex may collapse to (section 4.2, item 3).
enum class CollapseRule : uint8_t { Never, Free, AlongFeature, AlongBorder };
CollapseRule collapseRule(VertexKind from, VertexKind to);

// Collapses until at most settings.patches faces are left, and on while that costs nothing. Where features
// pin the mesh above that, says so in `shortfall`, with the number of patches that touch features.
Result<BaseDomain> simplify(ChannelMeshes meshes, const VectorizeSettings& settings, StageReport& report,
                            std::string& shortfall, Progress& progress);

}  // namespace tessera
