// The tool that reshapes: vertices, handles and whole curves.
#pragma once

#include <optional>

#include "app/edit_session.h"
#include "app/tools/tool.h"
#include "core/edit/reshape.h"

namespace tessera {

// A. A press on a control point or a curve takes hold of it: a click selects it (Shift adds it or takes it
// out), a drag moves all selected points with it or bends the curve; beside them a marquee selects points.
// While dragging, Shift keeps to multiples of 45 degrees and Alt breaks smooth joins. Arrows nudge the
// selected points by an image pixel, with Shift by ten, with Alt by one pixel of the screen; nudges are one
// step until the key is released. Where the photo is there, patches that still show it get their colours from
// it anew at the end.
class DirectTool : public DragTool {
  public:
    using DragTool::DragTool;

    bool keyPress(const ToolKey& key) override;
    bool keyRelease(const ToolKey& key) override;
    void forgetHover() override;
    bool active() const override { return mEdit || DragTool::active(); }
    ToolOverlay overlay() const override;

  protected:
    void hovered(const ToolEvent& event) override;
    void pressed(const ToolEvent& event) override;
    void clicked(const ToolEvent& event) override;
    void dragStarted(const ToolEvent& event) override;
    void dragged(const ToolEvent& event) override;
    void dropped(const ToolEvent& event) override;
    void abandoned() override;

  private:
    // What the pointer is on; nothing where all are none.
    struct Target {
        std::optional<ControlPointRef> point;
        std::optional<CurveHit> curve;

        bool any() const { return point || curve; }
    };

    Target targetAt(const ToolEvent& event) const;
    // The handles that can be seen, and so taken hold of: of selected vertices and curves, and selected ones
    // with the others at their vertex.
    std::vector<ControlPointRef> shownPoints() const;
    std::optional<ControlPointRef> nearestShown(glm::dvec2 point, double radiusPx) const;
    std::optional<ControlPointRef> nearestVertex(glm::dvec2 point, double radiusPx) const;
    // What arrows and drags move: the selected points, and those of selected curves.
    std::vector<ControlPointRef> movable() const;
    void toggle(const Target& target);
    void selectMarquee(const ToolEvent& event);
    bool openDrag(const QString& text, ShapeDrag drag);
    void showDrag(glm::dvec2 offset, bool breakJoins);
    // Ends the gesture as one step, with new colours where they are wanted.
    void finish();

    Target mHover;
    Target mHeld;
    std::optional<EditSession> mEdit;
    std::optional<ShapeDrag> mDrag;
    DragResult mResult;
    glm::dvec2 mOffset{0, 0};
    bool mBreakJoins = false;
    bool mNudging = false;
    std::optional<Rect> mMarquee;
    std::vector<ControlPointRef> mPointsBefore;
    std::vector<EdgeId> mCurvesBefore;
};

}  // namespace tessera
