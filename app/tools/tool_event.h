// What pointer and keys say to a tool, in the picture's terms.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace tessera {

struct ToolModifiers {
    bool shift = false;
    bool alt = false;
    bool control = false;

    bool operator==(const ToolModifiers&) const = default;
};

// Of the left button, or of none while the pointer hovers.
struct ToolEvent {
    glm::dvec2 point{0, 0};    // image px; may lie outside the picture
    double pxPerScreenPx = 1;  // image px for each logical pixel of the screen: what is "near" follows it
    ToolModifiers modifiers = {};
    bool onPhoto = false;  // the photo is what is seen there
};

enum class ToolKeyCode { Escape, Enter, Left, Right, Up, Down, Other };

struct ToolKey {
    ToolKeyCode code = ToolKeyCode::Other;
    ToolModifiers modifiers = {};
    double pxPerScreenPx = 1;
};

// Distances on the screen, logical px.
constexpr double kClickRadiusPx = 4;  // a press that stays within it is a click
constexpr double kHandleRadiusPx = 7;
constexpr double kCurveRadiusPx = 5;

// `offset` turned to the nearest multiple of 45 degrees, at the length of its part along that.
glm::dvec2 constrainedTo45(glm::dvec2 offset);

}  // namespace tessera
