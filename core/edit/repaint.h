// Repainting patches by a function of colour and place: what all colour edits are made of.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/edit/patch_set.h"
#include "core/edit/spline_edit.h"
#include "core/edit/touched.h"

namespace tessera {

// A colour as a repainting sees it, and where. Splines overshoot 0..1; functions are asked for the colour
// that a screen shows, since beyond it OKLab's roots make the wildest things of little.
struct PaintedColour {
    glm::dvec3 srgb{0};   // gamma-encoded, not premultiplied, within 0..1
    glm::dvec3 lab{0};    // the same in OKLab
    glm::dvec2 point{0};  // px
    glm::dvec3 whole{0};  // srgb before it was brought into 0..1

    PaintedColour() = default;
    explicit PaintedColour(glm::dvec3 colour, glm::dvec2 at = {});
};

struct Repaint {
    // Where there is one the function is not asked.
    std::optional<AffineColour> affine;
    std::function<glm::dvec3(const PaintedColour&)> function;  // thread-safe
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
    // and the weight 1 all over a patch; else fitted (SplineRefit), or made affine where that is as good.
    PatchSet apply(PatchMesh& mesh, const Repaint& repaint, Precision precision = Precision::Full) const;

  private:
    struct Patch;
    using Spline = std::optional<PatchSpline>;  // none where nothing changes
    static Spline repainted(const PatchMesh& mesh, Patch& patch, const Repaint& repaint);
    static Spline refitted(const PatchMesh& mesh, Patch& patch, const Repaint& repaint);
    // None where these points do not settle it.
    static std::optional<Spline> refittedAt(const PatchMesh& mesh, Patch& patch, const Repaint& repaint,
                                            const RefitPoints& at);
    static Spline sketched(const PatchMesh& mesh, Patch& patch, const Repaint& repaint);

    PatchMesh mStart;
    PatchSet mPatches;
    // What a patch's repainting needs again and again, found when it is first needed. Each patch is only ever
    // looked at by one thread at a time.
    std::shared_ptr<std::vector<Patch>> mCache;
};

}  // namespace tessera
