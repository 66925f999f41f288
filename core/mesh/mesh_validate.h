// Whether a PatchMesh is what it claims to be. Where every patch is certified and the border runs once around
// the picture, the patches cover it exactly once: a piecewise map whose Jacobian is positive everywhere has
// every point as often as its degree says, and the degree is the patches' area over the picture's.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/mesh/edge_blur.h"
#include "core/mesh/patch_mesh.h"

namespace tessera {

struct MeshValidation {
    std::vector<std::string> violations;  // a sentence each; at most kMaxViolations are kept
    size_t violationCount = 0;
    double minBernstein = 0;  // smallest coefficient of det J over all patches, relative to the base triangle
    size_t subdividedPatches = 0;  // certified only after subdividing
    double areaError = 0;          // |sum of patch areas - picture area| / picture area
    size_t uncoveredPixels = 0;    // pixel centres in no patch
    size_t doublePixels = 0;       // pixel centres in several

    bool valid() const { return violationCount == 0; }
};

constexpr size_t kMaxViolations = 100;

// Checks connectivity, the border (corners and straight sides of the picture), orientation, that the two
// sides of each edge have the same curve, the features' blur, each patch's certificate, the sum of areas, the
// splines' sizes and finiteness, the smooth joins, and which patches cover each pixel centre.
MeshValidation validate(const PatchMesh& mesh);

// The connectivity alone: empty where it is sound, else what is wrong.
std::vector<std::string> connectivityViolations(const HalfedgeMesh& mesh);

// The colour of a patch at parameters with their image point, as of blurredColour.
using ColourOf = std::function<void(PatchId, const Barycentric&, glm::dvec2 point, double* out)>;

// What is wrong with blurs: empty where each blurSigma is finite, not negative, and 0 where the edge is no
// feature, and where `colour` has beside the middle of each blurred edge no jump but that which the blur
// leaves near tips and junctions, within 1e-3. (No verdict where another feature's blur reaches that middle.)
std::vector<std::string> blurViolations(const PatchMesh& mesh, const EdgeBlur& blur, const ColourOf& colour);

// Whether the two curves of a join meet at its vertex with one tangent, but for the rounding to the lattice.
bool isSmooth(const PatchMesh& mesh, const SmoothJoin& join);

// Mean |difference| of the two sides' colours, blur included, along non-feature edges inside the picture with
// their ends, weighted by length; in levels of 1/255 of the working space, all channels together. p95 is the
// 95th percentile. Colour breaks are apart from the seams that should be narrow.
struct SeamStatistics {
    double mean = 0;
    double p95 = 0;
    double breakMean = 0;
    double breakP95 = 0;
    double breakLength = 0;  // px
};
SeamStatistics measureSeams(const PatchMesh& mesh);

}  // namespace tessera
