// Tools that select patches: by click and marquee, lasso, and colour.
#pragma once

#include "app/tools/tool.h"

namespace tessera {

// Drags a region that selects the patches whose centres it holds, as it grows. Escape gives back the
// selection from before.
class RegionTool : public DragTool {
  public:
    using DragTool::DragTool;

  protected:
    void pressed(const ToolEvent&) override { mBefore = session().selection().patches(); }
    // Selects the patch under the pointer; none outside the picture.
    void clicked(const ToolEvent& event) override;
    void abandoned() override;
    // Combines what was selected before the gesture with what the polygon holds.
    void selectPolygon(std::span<const glm::dvec2> polygon, const ToolModifiers& modifiers);
    void select(const PatchSet& found, const ToolModifiers& modifiers);

  private:
    PatchSet mBefore;
};

// V. A double click selects what features enclose.
class SelectTool : public RegionTool {
  public:
    using RegionTool::RegionTool;

    void doubleClick(const ToolEvent& event) override;
    ToolOverlay overlay() const override;

  protected:
    void dragged(const ToolEvent& event) override;

  private:
    Rect mMarquee;
};

// Q.
class LassoTool : public RegionTool {
  public:
    using RegionTool::RegionTool;

    ToolOverlay overlay() const override;
    ToolCursor cursor() const override { return ToolCursor::Cross; }

  protected:
    void dragStarted(const ToolEvent&) override { mPolygon = {start().point}; }
    void dragged(const ToolEvent& event) override;

  private:
    std::vector<glm::dvec2> mPolygon;
};

// Y. Selects what has the colour of the patch under the pointer.
class WandTool : public DragTool {
  public:
    using DragTool::DragTool;

    ToolCursor cursor() const override { return ToolCursor::Cross; }

  protected:
    void clicked(const ToolEvent& event) override;
    void dropped(const ToolEvent& event) override { clicked(event); }
};

}  // namespace tessera
