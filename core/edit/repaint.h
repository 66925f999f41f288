// Repainting patches by a function of colour and place: what all colour edits are made of.
#pragma once

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/edit/patch_set.h"
#include "core/edit/site_planes.h"
#include "core/edit/spline_edit.h"
#include "core/edit/touched.h"

namespace tessera {

// Colours as a repainting sees them, plane by plane, and where. Splines overshoot 0..1; functions are asked
// for the colour that a screen shows, since beyond it OKLab's roots make the wildest things of little.
struct PaintedColours {
    size_t count = 0;
    std::array<SitePlane, 3> srgb;   // gamma-encoded, not premultiplied, within 0..1
    std::array<SitePlane, 3> lab;    // the same in OKLab
    std::array<SitePlane, 2> point;  // px
    std::array<SitePlane, 3> whole;  // srgb before it was brought into 0..1

    // Adds a colour whose OKLab is yet to be made.
    void add(glm::dvec3 colour, glm::dvec2 at);
    void makeLab();
};

struct Repaint {
    // Where there is one the function is not asked.
    std::optional<AffineColour> affine;
    // Fills the first `count` of R, G and B; thread-safe.
    std::function<void(const PaintedColours&, SitePlanes& colours)> function;
    bool dependsOnPoint = false;
};

// How much of a repainting a place of a patch gets, 0..1; continuous in the patch. Thread-safe.
using PaintWeight = std::function<double(PatchId patch, glm::dvec2 point)>;

// Quick: for a frame of a gesture. The change is made affine in colour, and in place linear between corners.
enum class Precision { Full, Quick };

// Repaints the patches of one state of a mesh, any number of times.
class Repainter {
  public:
    // Weight 1 everywhere where there is no function.
    Repainter(PatchMesh start, PatchSet patches, PaintWeight weight = {});

    const PatchMesh& start() const { return mStart; }

    // Repaints a mesh that equals the start; the patches that changed. Exact where the repainting is affine
    // and the weight 1 all over a patch; else made affine and linear in place where that is near enough, with
    // what is missing fitted (withAdded) where it is not.
    PatchSet apply(PatchMesh& mesh, const Repaint& repaint, Precision precision = Precision::Full) const;

  private:
    struct Patch;
    struct Group;
    using Spline = std::optional<PatchSpline>;  // none where nothing changes
    void look(Group& group) const;
    void sketch(Group& group, const Repaint& repaint, std::span<Spline> splines) const;
    Spline repainted(const Patch& patch, const Repaint& repaint) const;
    Spline refitted(const Patch& patch, const Repaint& repaint, const AffineColour& guess) const;

    PatchMesh mStart;
    PatchSet mPatches;
    // What the frames of a gesture need again and again, found when it is first needed. Each group is only
    // ever looked at by one thread at a time.
    std::shared_ptr<std::vector<Group>> mGroups;
};

}  // namespace tessera
