// Tools that select patches: by click and marquee, lasso, and colour.
#pragma once

#include "app/tools/tool.h"

namespace tessera {

// Selects patches, but none that are locked: shows which ones those are.
class SelectingTool : public DragTool {
  public:
    using DragTool::DragTool;

    ToolOverlay overlay() const override;
    void forgetHover() override { mLock.reset(); }

  protected:
    void hovered(const ToolEvent& event) override;
    void pressed(const ToolEvent&) override { mLock.reset(); }
    // The patch there; none outside the picture, and none, with a word, where it is locked.
    std::optional<PatchId> patchClicked(const ToolEvent& event);

  private:
    std::optional<OverlayLock> lockAt(glm::dvec2 point) const;

    std::optional<OverlayLock> mLock;
};

// Drags a region that selects the patches whose centres it holds, as it grows. Escape gives back the
// selection from before.
class RegionTool : public SelectingTool {
  public:
    using SelectingTool::SelectingTool;

  protected:
    void pressed(const ToolEvent& event) override;
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
class WandTool : public SelectingTool {
  public:
    using SelectingTool::SelectingTool;

    ToolCursor cursor() const override { return ToolCursor::Cross; }

  protected:
    void clicked(const ToolEvent& event) override;
    void dropped(const ToolEvent& event) override { clicked(event); }
};

}  // namespace tessera
