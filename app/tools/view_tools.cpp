// See view_tools.h.
#include "app/tools/view_tools.h"

namespace tessera {

bool ZoomTool::keyPress(const ToolKey& key) {
    mOut = key.modifiers.alt;
    return false;
}

bool ZoomTool::keyRelease(const ToolKey& key) {
    return keyPress(key);
}

void ZoomTool::clicked(const ToolEvent& event) {
    host().changeView(ZoomStep{event.point, !event.modifiers.alt});
}

void ZoomTool::dragged(const ToolEvent& event) {
    mMarquee = {glm::min(start().point, event.point), glm::max(start().point, event.point)};
}

ToolOverlay ZoomTool::overlay() const {
    ToolOverlay overlay;
    if (dragging()) overlay.marquee = mMarquee;
    return overlay;
}

}  // namespace tessera
