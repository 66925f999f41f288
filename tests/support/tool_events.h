// A pointer and keys for tools, as a canvas at 100 % would send them.
#pragma once

#include "app/tools/tool_manager.h"

namespace tessera::testing {

struct Pointer {
    ToolManager& tools;
    double pxPerScreenPx = 1;
    ToolModifiers modifiers = {};

    ToolEvent at(glm::dvec2 point) const { return {point, pxPerScreenPx, modifiers}; }
    void press(glm::dvec2 point) const { tools.press(at(point)); }
    void move(glm::dvec2 point) const { tools.move(at(point)); }
    void release(glm::dvec2 point) const { tools.release(at(point)); }
    void click(glm::dvec2 point) const {
        press(point);
        release(point);
    }
    void doubleClick(glm::dvec2 point) const {
        click(point);
        tools.doubleClick(at(point));
        release(point);
    }
    void drag(glm::dvec2 from, glm::dvec2 to, int steps = 5) const {
        press(from);
        for (int i = 1; i <= steps; ++i) move(from + (to - from) * (double(i) / steps));
        release(to);
    }
    bool key(ToolKeyCode code) const {
        const bool used = tools.keyPress({code, modifiers, pxPerScreenPx});
        tools.keyRelease({code, modifiers, pxPerScreenPx});
        return used;
    }
};

}  // namespace tessera::testing
