// Recolouring of selected patches.
//
// Edits that are affine in gamma-encoded sRGB go through the splines' coefficients and are exact but for
// rounding. Others are fitted to the edited colours at points of each patch: the mean deviation is at most a
// level of 1/255. Colours are changed before alpha multiplies them; alpha stays. Values are not clamped. The
// blur of features needs no care: it follows the colours of the two sides.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <variant>

#include "core/edit/palette.h"
#include "core/edit/patch_set.h"
#include "core/edit/touched.h"

namespace tessera {

// All colours are gamma-encoded sRGB, 0..1, not premultiplied. The default value of each changes nothing,
// ReplaceColour and GradientRecolour apart.

// In OKLCH.
struct ColourShift {
    double hueDegrees = 0;
    double chromaFactor = 1;
    double lightnessShift = 0;  // 1 is from black to white
};
// The selection's mean colour becomes `to`; differences from it stay.
struct ReplaceColour {
    glm::dvec3 to{0};
};
// Goes `strength` (0..1) of the way to the hue and saturation of a colour; luma stays.
struct Tint {
    glm::dvec3 colour{0};
    double strength = 0;
};
// Both -1..1: contrast -1 leaves mid grey, 1 doubles all differences from it.
struct Levels {
    double brightness = 0;
    double contrast = 0;
};
// Goes `strength` (0..1) of the way to a gradient between two image points, constant beyond them.
struct GradientRecolour {
    glm::dvec2 from{0}, to{0};  // px
    glm::dvec3 fromColour{0}, toColour{0};
    double strength = 1;
};
// An entry of a palette becomes another colour: each colour goes along by its share of the entry.
struct PaletteShift {
    Palette palette;
    int entry = 0;
    glm::dvec3 to{0};
};
using Recolouring = std::variant<ColourShift, ReplaceColour, Tint, Levels, GradientRecolour, PaletteShift>;

struct RecolourOptions {
    // 0: a hard border. Else the edit fades from this many px inside the set's border to as many outside,
    // where it is half there at the border; not at features, nor at the picture's border. Locked patches stay:
    // where one is that the fade would reach, colours break.
    double featherPx = 0;
};

// Changes the editable patches of the set, and with a soft border those around it. With a hard one, its edges
// that are no features become colour breaks.
Touched recolour(PatchMesh& mesh, const PatchSet& set, const Recolouring& how,
                 const RecolourOptions& options = {});

// The same for a gesture: what depends on the start state alone is computed once. Both calls change a mesh
// that equals the start; one call at a time.
class Recolourer {
  public:
    Recolourer(PatchMesh start, PatchSet set, RecolourOptions options = {});
    ~Recolourer();
    Recolourer(Recolourer&&) noexcept;
    Recolourer& operator=(Recolourer&&) noexcept;

    // What recolour() does.
    Touched apply(PatchMesh& mesh, const Recolouring& how) const;
    // Nearly that, in a small part of the time: for the frames before the last one. Colours are some levels
    // off where a patch has many of them and the edit is not affine.
    Touched preview(PatchMesh& mesh, const Recolouring& how) const;

  private:
    struct State;
    std::unique_ptr<State> mState;
};

}  // namespace tessera
