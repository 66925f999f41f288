// The dominant colours of a picture, and how much of each there is in a colour (after Chang, Fried, Liu,
// DiVerdi and Finkelstein, Palette-based Photo Recoloring, 2015).
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/edit/patch_colours.h"
#include "core/edit/touched.h"

namespace tessera {

struct PaletteEntry {
    glm::dvec3 colour{0};  // gamma-encoded sRGB
    double weight = 0;     // share of the picture's area
    size_t patches = 0;    // nearest to this entry
};

struct Palette {
    static constexpr int kLeast = 5, kMost = 16;
    static constexpr uint8_t kNone = 255;

    std::vector<PaletteEntry> entries;  // by falling weight
    std::vector<uint8_t> nearest;       // by patch id: its entry; kNone where there is no patch
    double spread = 0;                  // in OKLab: of the shares
};

// By k-means in OKLab over the patches' mean colours, weighted by area and chroma. `count` is brought into
// kLeast..kMost; fewer entries where there are fewer colours. The search begins from `like` (gamma-encoded
// sRGB) as far as they are colours of the picture: so entries stay what they are through an edit. The same
// for the same arguments.
Palette palette(const PatchMesh& mesh, const PatchColours& colours, int count,
                std::span<const glm::dvec3> like = {});

// How much of an entry is in each of `count` colours, all in OKLab, the colours in three planes: the shares
// of all entries are at least 0, 1 in sum, and continuous.
void paletteShares(std::span<const glm::dvec3> entries, double spread, size_t entry, const float* const* lab,
                   size_t count, float* shares);

// The patches nearest to an entry.
PatchSet patchesOf(const Palette& palette, int entry);

// The entry becomes another colour in the whole picture: each colour goes along by its share of the entry, so
// that no seam opens.
Touched recolourPalette(PatchMesh& mesh, const Palette& palette, int entry, glm::dvec3 newColour);

}  // namespace tessera
