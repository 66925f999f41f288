// The tool that makes features sharp or soft by a handle on the canvas.
#pragma once

#include <array>
#include <optional>

#include "app/edit_session.h"
#include "app/tools/tool.h"

namespace tessera {

// A press takes hold of a feature or of the handle beside it; away from the curve is softer. The handle is as
// far from the curve as the blur reaches. It changes the whole feature, from junction to junction, by the
// same widths, or the one curve; near the end of a single curve that end alone. The blur grows no further
// than the next feature leaves room (blur_room.h).
class BlurTool : public DragTool {
  public:
    using DragTool::DragTool;

    ToolCursor cursor() const override { return ToolCursor::Cross; }
    void forgetHover() override { mHover.reset(); }
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
    std::optional<CurveHit> featureAt(const ToolEvent& event) const;

    std::optional<CurveHit> mHover;
    std::optional<CurveHit> mHeld;
    std::vector<EdgeId> mEdges;
    std::vector<std::array<double, 2>> mRoom;  // for mEdges
    std::optional<EditSession> mEdit;
    double mPxPerScreenPx = 1;
};

// The curves of the feature that `edge` is of, in order, from one junction, tip or border to the next; the
// edge alone where it is no feature.
std::vector<EdgeId> wholeFeature(const PatchMesh& mesh, EdgeId edge);

}  // namespace tessera
