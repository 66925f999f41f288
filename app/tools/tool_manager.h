// The tools of one window: which is in use, what they share, and the events on their way to it.
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QPointer>
#include <array>
#include <memory>
#include <vector>

#include "app/tools/tool.h"

namespace tessera {

// The canvas turns its events into these calls and draws overlay(); all of them are of no effect while no
// document is open, and those of tools that need patches while there are none.
class ToolManager : public QObject, private ToolHost {
    Q_OBJECT

  public:
    explicit ToolManager(QObject* parent = nullptr);
    ~ToolManager() override;

    // The document that the events are about; null for none. A gesture on the one before is cancelled.
    void setSession(DocumentSession* session);
    ToolId tool() const { return mCurrent; }
    // Cancels a gesture of the tool before.
    void setTool(ToolId id);
    const ToolOptions& options() const override { return mOptions; }
    void setOptions(const ToolOptions& options) override;
    // finishNow where nothing else is said.
    void setFinish(FinishGesture finish) { mFinish = std::move(finish); }
    const FinishGesture& finish() const override { return mFinish; }

    void press(const ToolEvent& event);
    void move(const ToolEvent& event);
    void release(const ToolEvent& event);
    void doubleClick(const ToolEvent& event);
    void leave();
    // Whether the key was of use. Escape ends the gesture, or else the selection.
    bool keyPress(const ToolKey& key);
    bool keyRelease(const ToolKey& key);
    // The focus is lost, the window deactivated: the release may never come.
    void cancel();

    bool active() const { return current().active(); }
    // Whether the tool can be used on what is open.
    bool usable(ToolId id) const;
    ToolOverlay overlay() const;
    ToolCursor cursor() const;

  signals:
    void toolChanged();
    void optionsChanged();
    // overlay() or cursor() may be another one.
    void overlayChanged();
    void viewRequested(const tessera::ViewRequest& request);
    void said(const QString& text);

  private:
    DocumentSession& session() override { return *mSession; }
    void changeView(const ViewRequest& request) override { emit viewRequested(request); }
    void say(const QString& text) override { emit said(text); }

    // The step that a nudge key has just made.
    struct Nudge {
        uint64_t revision = 0;  // that it led to; 0 for none
        bool horizontal = false;
        std::vector<ControlPointRef> points = {};
        std::vector<EdgeId> curves = {};
        QElapsedTimer since = {};
    };
    // Makes one step of this nudge, which began at `before`, and the one right before it, where they are
    // alike.
    void joinNudge(uint64_t before, ToolKeyCode code);

    Tool& current() const { return *mTools[size_t(mCurrent)]; }
    // Hands the event on where the tool can be used.
    void send(void (Tool::*handler)(const ToolEvent&), const ToolEvent& event);

    QPointer<DocumentSession> mSession;
    ToolOptions mOptions;
    FinishGesture mFinish = finishNow;
    Nudge mNudge;
    ToolId mCurrent = ToolId::Select;
    std::array<std::unique_ptr<Tool>, size_t(ToolId::Count)> mTools;
};

}  // namespace tessera
