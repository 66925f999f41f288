// A tool as a state machine over ToolEvents: it knows no widget, draws nothing, and changes documents through
// EditSessions alone.
#pragma once

#include <QString>
#include <optional>
#include <variant>

#include "app/element_edits.h"
#include "app/tools/tool_event.h"
#include "app/tools/tool_options.h"
#include "app/tools/tool_overlay.h"

namespace tessera {

enum class ToolId {
    Select,
    Direct,
    Lasso,
    Wand,
    Eyedropper,
    Brush,
    DragColour,
    Gradient,
    Blur,
    Hand,
    Zoom,
    Count
};

enum class ToolCursor { Arrow, Cross, OpenHand, ClosedHand, ZoomIn, ZoomOut, Eyedropper, None };

// What a tool asks of the view.
struct PanBy {
    glm::dvec2 offset{0, 0};  // image px by which the picture moves on the screen
};
struct ZoomStep {
    glm::dvec2 at{0, 0};
    bool in = true;
};
struct ShowRect {
    Rect rect;
};
using ViewRequest = std::variant<PanBy, ZoomStep, ShowRect>;

// What a tool can reach. Events come only while a document is open.
class ToolHost {
  public:
    virtual ~ToolHost() = default;
    virtual DocumentSession& session() = 0;
    virtual const ToolOptions& options() const = 0;
    virtual void setOptions(const ToolOptions& options) = 0;
    virtual void changeView(const ViewRequest& request) = 0;
    // One sentence for the person.
    virtual void say(const QString& text) = 0;
    // Ends gestures whose last edit may take longer than a frame.
    virtual const FinishGesture& finish() const = 0;
};

class Tool {
  public:
    explicit Tool(ToolHost& host) : mHost(host) {}
    virtual ~Tool() = default;
    Tool(const Tool&) = delete;
    Tool& operator=(const Tool&) = delete;

    virtual void press(const ToolEvent& event) = 0;
    virtual void move(const ToolEvent& event) = 0;  // with or without the button
    virtual void release(const ToolEvent& event) = 0;
    // After press and release of its first click; its own release follows.
    virtual void doubleClick(const ToolEvent& event) { press(event); }
    // Whether the tool had a use for the key.
    virtual bool keyPress(const ToolKey&) { return false; }
    virtual bool keyRelease(const ToolKey&) { return false; }
    // Ends a gesture as if it had never begun: Escape, another tool, another document.
    virtual void cancel() = 0;
    // The pointer has left the canvas, or ids that it hovered may be gone.
    virtual void forgetHover() {}
    virtual bool active() const = 0;  // a gesture is under way

    virtual ToolOverlay overlay() const { return {}; }
    virtual ToolCursor cursor() const { return ToolCursor::Arrow; }
    // Whether there must be patches.
    virtual bool needsMesh() const { return true; }

  protected:
    DocumentSession& session() const { return mHost.session(); }
    const PatchMesh& mesh() const { return session().document().mesh; }
    const ToolOptions& options() const { return mHost.options(); }
    ToolHost& host() const { return mHost; }
    // Whether a gesture can be opened; says that another one (of a panel, say) or an edit under way is in its
    // way.
    bool mayBegin() const;
    // Opens a gesture; false, and none is open, where mayBegin() is false.
    bool begin(std::optional<EditSession>& edit, const QString& text) const;
    // Says what failed, if anything did.
    void report(const Result<void>& result) const;

  private:
    ToolHost& mHost;
};

// The states that all pointer tools share: at rest, pressed (click or drag: not known yet), dragging.
class DragTool : public Tool {
  public:
    using Tool::Tool;

    void press(const ToolEvent& event) final;
    void move(const ToolEvent& event) final;
    void release(const ToolEvent& event) final;
    void cancel() final;
    bool active() const override { return mState != State::Rest; }

  protected:
    virtual void hovered(const ToolEvent&) {}
    virtual void pressed(const ToolEvent&) {}
    // Released where it was pressed.
    virtual void clicked(const ToolEvent&) {}
    // The pointer has left the click radius; then, and with each further move, dragged().
    virtual void dragStarted(const ToolEvent&) {}
    virtual void dragged(const ToolEvent&) {}
    virtual void dropped(const ToolEvent&) {}
    // Gives back what the gesture has changed so far.
    virtual void abandoned() {}
    // Whether a press is a drag from the first moment on.
    virtual bool dragsAtOnce() const { return false; }

    bool dragging() const { return mState == State::Dragging; }
    const ToolEvent& start() const { return mStart; }

  private:
    enum class State { Rest, Pressed, Dragging };

    void startDragging(const ToolEvent& event);

    State mState = State::Rest;
    ToolEvent mStart;
};

// Shift adds, Alt subtracts, both intersect.
SelectMode selectModeOf(const ToolModifiers& modifiers);

}  // namespace tessera
