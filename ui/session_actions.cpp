// See session_actions.h.
#include "ui/session_actions.h"

#include <array>

#include "app/edit_actions.h"
#include "app/message.h"
#include "app/selection_actions.h"
#include "ui/action_table.h"

namespace tessera {

namespace {

enum Needs : unsigned {
    kMesh = 0,
    kPatches = 1,  // selected ones
    kCurves = 2,   // selected ones
    kPhoto = 4,
    // Something to do it to.
    kHidden = 8,
    kLocked = 16,
    kCutOut = 32,    // among the selected patches
    kOpaque = 64,    // among the selected patches
    kPlain = 128,    // among the selected curves
    kFeature = 256,  // among the selected curves
};

struct SessionAction {
    ActionId id;
    unsigned needs;
    // What there is to say, if anything.
    QString (*run)(Workspace&, const ToolManager&);
};

QString wordsOf(const Result<void>& result) {
    return result ? QString() : asSentence(result.error().message);
}

template <void (*kRun)(DocumentSession&)>
QString always(Workspace& workspace, const ToolManager&) {
    kRun(*workspace.session());
    return {};
}

template <Result<void> (*kRun)(DocumentSession&)>
QString perhaps(Workspace& workspace, const ToolManager&) {
    return wordsOf(kRun(*workspace.session()));
}

// The workspace says what there is to say of these.
template <Result<ElementEdit> (*kPrepare)(const DocumentSession&)>
QString elements(Workspace& workspace, const ToolManager&) {
    workspace.edit(kPrepare(*workspace.session()));
    return {};
}

template <PatchFlag kFlag, bool kOn>
QString flag(Workspace& workspace, const ToolManager&) {
    return wordsOf(setFlag(*workspace.session(), kFlag, kOn));
}

template <PatchFlag kFlag>
QString clear(Workspace& workspace, const ToolManager&) {
    return wordsOf(clearFlag(*workspace.session(), kFlag));
}

template <bool kOn>
QString feature(Workspace& workspace, const ToolManager&) {
    workspace.edit(setFeature(*workspace.session(), kOn));
    return {};
}

QString similar(Workspace& workspace, const ToolManager& tools) {
    selectSimilar(*workspace.session(), tools.options().wand);
    return {};
}

const std::array kSessionActions{
    SessionAction{ActionId::SelectAll, kMesh, always<selectAll>},
    SessionAction{ActionId::SelectNone, kMesh, always<selectNone>},
    SessionAction{ActionId::InvertSelection, kMesh, always<invertSelection>},
    SessionAction{ActionId::GrowSelection, kPatches, always<growSelection>},
    SessionAction{ActionId::ShrinkSelection, kPatches, always<shrinkSelection>},
    SessionAction{ActionId::SelectSimilar, kPatches, similar},
    SessionAction{ActionId::ResetColours, kPatches, perhaps<resetColours>},
    SessionAction{ActionId::ResetShape, kPatches, perhaps<resetShape>},
    SessionAction{ActionId::RefitColours, kPatches | kPhoto, elements<refitColours>},
    SessionAction{ActionId::Hide, kPatches, flag<PatchFlag::Hidden, true>},
    SessionAction{ActionId::ShowAll, kHidden, clear<PatchFlag::Hidden>},
    SessionAction{ActionId::Lock, kPatches, flag<PatchFlag::Locked, true>},
    SessionAction{ActionId::UnlockAll, kLocked, clear<PatchFlag::Locked>},
    SessionAction{ActionId::CutOut, kOpaque, flag<PatchFlag::CutOut, true>},
    SessionAction{ActionId::FillIn, kCutOut, flag<PatchFlag::CutOut, false>},
    SessionAction{ActionId::SplitPatches, kPatches, elements<splitPatches>},
    SessionAction{ActionId::SplitCurves, kCurves, elements<splitCurves>},
    SessionAction{ActionId::MergeCurves, kCurves, elements<mergeCurves>},
    SessionAction{ActionId::SnapToFeature, kCurves | kPhoto, elements<snapToFeature>},
    SessionAction{ActionId::MarkFeature, kPlain, feature<true>},
    SessionAction{ActionId::UnmarkFeature, kFeature, feature<false>},
};

// All that actions could need and that is there.
unsigned offered(const DocumentSession& session) {
    const PatchMesh& mesh = session.document().mesh;
    const Selection& selection = session.selection();
    unsigned found = session.photo().image ? unsigned{kPhoto} : 0;
    if (!selection.patches().empty()) found |= kPatches;
    if (!selection.curves().empty()) found |= kCurves;
    if (!session.marks().hidden().empty()) found |= kHidden;
    if (!session.marks().locked().empty()) found |= kLocked;
    for (const PatchId p : selection.patches()) found |= mesh.attributes(p).cutOut ? kCutOut : kOpaque;
    for (const EdgeId e : selection.curves()) found |= mesh.curve(e).feature ? kFeature : kPlain;
    return found;
}

}  // namespace

void connectSessionActions(const ActionTable& actions, QObject* receiver, Workspace& workspace,
                           const ToolManager& tools, std::function<void(const QString&)> say) {
    for (const SessionAction& action : kSessionActions)
        QObject::connect(actions[action.id], &QAction::triggered, receiver, [=, &workspace, &tools] {
            const DocumentSession* session = workspace.session();
            if (!session || !session->hasMesh()) return;
            const QString words = action.run(workspace, tools);
            if (!words.isEmpty()) say(words);
        });
}

void enableSessionActions(const ActionTable& actions, const DocumentSession* session) {
    const bool hasMesh = session && session->hasMesh();
    const unsigned found = hasMesh ? offered(*session) : 0;
    for (const SessionAction& action : kSessionActions)
        actions[action.id]->setEnabled(hasMesh && (action.needs & ~found) == 0);
}

}  // namespace tessera
