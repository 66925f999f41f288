// What a tool wants to be seen over the picture. A value: the canvas draws it, in sizes of its own.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/edit/reshape.h"
#include "core/mesh/patch_query.h"

namespace tessera {

struct OverlayHandle {
    enum class Shape { Vertex, Control, Blur, End };
    Shape shape = Shape::Vertex;
    glm::dvec2 at{0, 0};
    bool selected = false;
    bool hovered = false;
};

struct OverlayLine {
    glm::dvec2 from{0, 0};
    glm::dvec2 to{0, 0};
};

struct OverlayRing {
    glm::dvec2 centre{0, 0};
    double radiusPx = 0;
    double innerRadiusPx = 0;  // of full strength
};

struct OverlayGradient {
    OverlayLine line;
    glm::dvec3 fromColour{0};
    glm::dvec3 toColour{0};
};

struct OverlaySwatch {
    glm::dvec2 at{0, 0};
    glm::dvec3 colour{0};
};

// Why a patch is passed over.
struct OverlayLock {
    PatchId patch;
    glm::dvec2 at{0, 0};
};

// All places in image px; colours gamma-encoded sRGB.
struct ToolOverlay {
    std::optional<Rect> marquee;
    std::vector<glm::dvec2> lasso;         // a polygon, closed from its last point to its first
    std::vector<OverlayLine> handleLines;  // from a vertex to its handles
    std::vector<OverlayHandle> handles;
    std::vector<EdgeId> curves;  // selected or under the pointer
    std::optional<EdgeId> hoveredCurve;
    std::optional<PatchId> blocking;  // would fold, or is locked: why a drag goes no further
    std::optional<OverlayLock> lock;  // the locked patch under the pointer
    std::optional<OverlayRing> ring;
    std::optional<OverlayGradient> gradient;
    std::optional<OverlaySwatch> swatch;  // what the eyedropper would pick
};

}  // namespace tessera
