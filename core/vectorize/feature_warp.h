// The free-form deformation that takes fitted feature curves back to the polylines they were fitted to, so
// that colours are sampled on the right side (paper section 4.4, Fig. 11): multilevel cubic B-splines (Lee et
// al. 1995), composed.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "core/mesh/patch_mesh.h"

namespace tessera {

struct PointPair {
    glm::dvec2 from;
    glm::dvec2 to;
};

// One-to-one by construction: it is a composition of cubic B-spline deformations, each with control
// displacements below .48 of its lattice spacing along either axis (Choi and Lee 2000). The identity more
// than a few pixels away from all pairs.
class FeatureWarp {
  public:
    // Over [0, width] x [0, height] px. Without pairs, the identity.
    FeatureWarp(double width, double height, std::span<const PointPair> pairs);

    glm::dvec2 operator()(glm::dvec2 point) const;

    // The largest distance from a pair's image to where it should be.
    double residual() const { return mResidual; }

  private:
    struct Level {
        double spacing;
        int columns, rows;
        std::vector<glm::vec2> controls;  // (columns x rows), the first at (-spacing, -spacing)

        glm::dvec2 displacement(glm::dvec2 point) const;
    };
    static Level approximate(double width, double height, double spacing, std::span<const PointPair> pairs);

    std::vector<Level> mLevels;
    double mResidual = 0;
};

// Corresponding points of each feature curve (by arc length) and its polyline (by chord length), about a
// pixel apart. `paths` by edge, as in BaseDomain.
std::vector<PointPair> featurePairs(const PatchMesh& mesh, std::span<const std::vector<glm::dvec2>> paths);

}  // namespace tessera
