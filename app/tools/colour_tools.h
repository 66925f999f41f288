// Tools that pick colours up and lay them down.
#pragma once

#include <optional>

#include "app/edit_session.h"
#include "app/recolour_gesture.h"
#include "app/tools/tool.h"
#include "core/edit/brush.h"

namespace tessera {

// I. A click makes the colour under the pointer the current one; Alt turns from the vector image to the
// original or back; with Shift the selected patches take it, keeping their shading.
class EyedropperTool : public DragTool {
  public:
    using DragTool::DragTool;

    bool needsMesh() const override { return false; }
    ToolCursor cursor() const override { return ToolCursor::Eyedropper; }
    void forgetHover() override { mSwatch.reset(); }
    ToolOverlay overlay() const override;

  protected:
    bool dragsAtOnce() const override { return true; }
    void hovered(const ToolEvent& event) override;
    void dragged(const ToolEvent& event) override { hovered(event); }
    void dropped(const ToolEvent& event) override;
    void abandoned() override { mSwatch.reset(); }

  private:
    std::optional<OverlaySwatch> mSwatch;
};

// B. Draws strokes of the current colour. [ and ] are the canvas's: they set the options.
class BrushTool : public DragTool {
  public:
    using DragTool::DragTool;

    ToolCursor cursor() const override { return ToolCursor::Cross; }
    void forgetHover() override { mPointer.reset(); }
    ToolOverlay overlay() const override;

  protected:
    bool dragsAtOnce() const override { return true; }
    void hovered(const ToolEvent& event) override { mPointer = event.point; }
    void dragStarted(const ToolEvent& event) override;
    void dragged(const ToolEvent& event) override;
    void dropped(const ToolEvent& event) override;
    void abandoned() override {
        mPainting.reset();
        mEdit.reset();
    }

  private:
    std::optional<glm::dvec2> mPointer;
    std::vector<glm::dvec2> mStroke;
    std::optional<EditSession> mEdit;
    std::optional<BrushStroke> mPainting;  // as the options were at the press
};

// Carries the colour of a patch from where it is taken to where it is dropped, as on a gradient mesh; a click
// lays down the current colour.
class DragColourTool : public DragTool {
  public:
    using DragTool::DragTool;

    ToolCursor cursor() const override { return ToolCursor::Cross; }
    ToolOverlay overlay() const override;

  protected:
    void clicked(const ToolEvent& event) override;
    void dragStarted(const ToolEvent& event) override;
    void dragged(const ToolEvent& event) override;
    void dropped(const ToolEvent& event) override;
    void abandoned() override;

  private:
    // Gives the patch at a point a colour there.
    void lay(glm::dvec2 point, glm::dvec3 colour);

    std::optional<EditSession> mEdit;
    glm::dvec3 mColour{0};
    glm::dvec2 mPointer{0, 0};
};

// Draws a line along which the selected patches go from the current colour to the second one.
class GradientTool : public DragTool {
  public:
    using DragTool::DragTool;

    ToolCursor cursor() const override { return ToolCursor::Cross; }
    ToolOverlay overlay() const override;

  protected:
    void clicked(const ToolEvent& event) override;
    void dragStarted(const ToolEvent& event) override;
    void dragged(const ToolEvent& event) override;
    void dropped(const ToolEvent& event) override;
    void abandoned() override;

  private:
    std::optional<RecolourGesture> mGesture;
    OverlayLine mLine;
};

}  // namespace tessera
