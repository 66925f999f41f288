// Tools that change the view alone, and so work on a photo too.
#pragma once

#include "app/tools/tool.h"

namespace tessera {

// H.
class HandTool : public DragTool {
  public:
    using DragTool::DragTool;

    bool needsMesh() const override { return false; }
    ToolCursor cursor() const override { return active() ? ToolCursor::ClosedHand : ToolCursor::OpenHand; }

  protected:
    bool dragsAtOnce() const override { return true; }
    // The image point that was taken hold of comes back under the pointer.
    void dragged(const ToolEvent& event) override {
        if (event.point != start().point) host().changeView(PanBy{event.point - start().point});
    }
};

// Z. A click zooms in, with Alt out; a marquee fills the canvas.
class ZoomTool : public DragTool {
  public:
    using DragTool::DragTool;

    bool needsMesh() const override { return false; }
    ToolCursor cursor() const override { return mOut ? ToolCursor::ZoomOut : ToolCursor::ZoomIn; }
    bool keyPress(const ToolKey& key) override;
    bool keyRelease(const ToolKey& key) override;
    ToolOverlay overlay() const override;

  protected:
    void hovered(const ToolEvent& event) override { mOut = event.modifiers.alt; }
    void pressed(const ToolEvent& event) override { hovered(event); }
    void clicked(const ToolEvent& event) override;
    void dragged(const ToolEvent& event) override;
    void dropped(const ToolEvent&) override { host().changeView(ShowRect{mMarquee}); }

  private:
    Rect mMarquee;
    bool mOut = false;
};

}  // namespace tessera
