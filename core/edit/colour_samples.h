// A patch's own colours at points of its domain, as edits see them.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/patch_mesh.h"

namespace tessera {

struct ColourSample {
    glm::dvec3 srgb{0};  // gamma-encoded, not premultiplied
    double alpha = 1;
};

// Colours below this opacity are not divided by it.
constexpr double kLeastAlpha = 1.0 / 512;

// Points of a domain, split by axis as evaluateSplines wants them.
struct DomainPoints {
    std::vector<float> x, y;

    DomainPoints() = default;
    explicit DomainPoints(std::span<const Barycentric> points);
    size_t size() const { return x.size(); }
};

// Without blur.
std::vector<ColourSample> sampleColours(const PatchMesh& mesh, PatchId p, const DomainPoints& points);
ColourSample sampleColour(const PatchMesh& mesh, PatchId p, const Barycentric& at);

// A lattice over the domain with n steps a side: all its points, row by row from side ab.
std::vector<Barycentric> latticeOf(int n);

}  // namespace tessera
