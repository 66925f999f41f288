// See tool_manager.h.
#include "app/tools/tool_manager.h"

#include "app/tools/blur_tool.h"
#include "app/tools/colour_tools.h"
#include "app/tools/direct_tool.h"
#include "app/tools/region_tools.h"
#include "app/tools/view_tools.h"

namespace tessera {

namespace {

// Whoever waits longer means another step.
constexpr qint64 kNudgesApartMs = 1000;

}  // namespace

ToolManager::ToolManager(QObject* parent) : QObject(parent) {
    ToolHost& host = *this;
    const auto add = [&](ToolId id, std::unique_ptr<Tool> tool) { mTools[size_t(id)] = std::move(tool); };
    add(ToolId::Select, std::make_unique<SelectTool>(host));
    add(ToolId::Direct, std::make_unique<DirectTool>(host));
    add(ToolId::Lasso, std::make_unique<LassoTool>(host));
    add(ToolId::Wand, std::make_unique<WandTool>(host));
    add(ToolId::Eyedropper, std::make_unique<EyedropperTool>(host));
    add(ToolId::Brush, std::make_unique<BrushTool>(host));
    add(ToolId::DragColour, std::make_unique<DragColourTool>(host));
    add(ToolId::Gradient, std::make_unique<GradientTool>(host));
    add(ToolId::Blur, std::make_unique<BlurTool>(host));
    add(ToolId::Hand, std::make_unique<HandTool>(host));
    add(ToolId::Zoom, std::make_unique<ZoomTool>(host));
}

ToolManager::~ToolManager() = default;

void ToolManager::setSession(DocumentSession* session) {
    if (session == mSession) return;
    cancel();
    if (mSession) mSession->disconnect(this);
    mSession = session;
    mNudge = {};
    leave();
    if (!mSession) return;
    connect(mSession, &DocumentSession::changed, this, [this](const Change& change) {
        // What the pointer was on may be gone or elsewhere.
        if (change.mesh() && !change.preview) current().forgetHover();
        if (change.mesh()) emit overlayChanged();
    });
    connect(&mSession->selection(), &Selection::changed, this, &ToolManager::overlayChanged);
}

void ToolManager::setTool(ToolId id) {
    if (id == mCurrent) return;
    cancel();
    current().forgetHover();
    mCurrent = id;
    emit toolChanged();
    emit overlayChanged();
}

void ToolManager::setOptions(const ToolOptions& options) {
    mOptions = options;
    emit optionsChanged();
    emit overlayChanged();
}

bool ToolManager::usable(ToolId id) const {
    return mSession && (mSession->hasMesh() || !mTools[size_t(id)]->needsMesh());
}

void ToolManager::send(void (Tool::*handler)(const ToolEvent&), const ToolEvent& event) {
    if (!usable(mCurrent)) return;
    (current().*handler)(event);
    emit overlayChanged();
}

void ToolManager::press(const ToolEvent& event) {
    send(&Tool::press, event);
}

void ToolManager::move(const ToolEvent& event) {
    send(&Tool::move, event);
}

void ToolManager::release(const ToolEvent& event) {
    send(&Tool::release, event);
}

void ToolManager::doubleClick(const ToolEvent& event) {
    send(&Tool::doubleClick, event);
}

void ToolManager::leave() {
    if (!active()) current().forgetHover();
    emit overlayChanged();
}

bool ToolManager::keyPress(const ToolKey& key) {
    if (!usable(mCurrent)) return false;
    if (key.code == ToolKeyCode::Escape) {
        if (active())
            cancel();
        else
            mSession->selection().clear();
        return true;
    }
    const bool used = current().keyPress(key);
    emit overlayChanged();
    return used;
}

bool ToolManager::keyRelease(const ToolKey& key) {
    if (!usable(mCurrent)) return false;
    const uint64_t before = mSession->revision();
    const bool used = current().keyRelease(key);
    if (used && mSession->revision() != before) joinNudge(before, key.code);
    emit overlayChanged();
    return used;
}

void ToolManager::joinNudge(uint64_t before, ToolKeyCode code) {
    const Selection& selection = mSession->selection();
    Nudge nudge{.revision = mSession->revision(),
                .horizontal = code == ToolKeyCode::Left || code == ToolKeyCode::Right,
                .points = selection.points(),
                .curves = selection.curves()};
    nudge.since.start();
    const bool alike = mNudge.revision == before && mNudge.horizontal == nudge.horizontal &&
                       mNudge.points == nudge.points && mNudge.curves == nudge.curves;
    if (alike && !mNudge.since.hasExpired(kNudgesApartMs)) mSession->history().joinLast();
    mNudge = std::move(nudge);
}

void ToolManager::cancel() {
    if (mSession) current().cancel();
    emit overlayChanged();
}

ToolOverlay ToolManager::overlay() const {
    return usable(mCurrent) ? current().overlay() : ToolOverlay();
}

ToolCursor ToolManager::cursor() const {
    return usable(mCurrent) ? current().cursor() : ToolCursor::Arrow;
}

}  // namespace tessera
