// The mean colour of each patch, kept and brought up to date: what the wand and the palette compare.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/edit/patch_set.h"

namespace tessera {

struct PatchColour {
    glm::dvec3 srgb{0};  // gamma-encoded, not premultiplied
    glm::dvec3 lab{0};   // the same in OKLab
    double alpha = 1;
    double area = 0;  // px^2
};

// Distance in OKLab; a difference of opacity counts as one of lightness.
double colourDistance(const PatchColour& a, const PatchColour& b);

// The mean over the patch's domain. Without blur.
PatchColour meanColour(const PatchMesh& mesh, PatchId p);

class PatchColours {
  public:
    PatchColours() = default;
    explicit PatchColours(const PatchMesh& mesh);

    // Looks again at the patches that changed. After changes of topology a new PatchColours is needed.
    void update(const PatchMesh& mesh, std::span<const PatchId> changed);

    const PatchColour& operator[](PatchId p) const { return mColours[p.index]; }
    size_t size() const { return mColours.size(); }

  private:
    std::vector<PatchColour> mColours;  // by patch id
};

// The mean over a set, weighted by area; not premultiplied, gamma-encoded sRGB.
glm::dvec3 meanColour(const PatchMesh& mesh, const PatchSet& set);

}  // namespace tessera
