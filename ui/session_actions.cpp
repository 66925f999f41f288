// See session_actions.h.
#include "ui/session_actions.h"

#include <QCursor>
#include <QGuiApplication>
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
    // What there is to say: a failure, or a remark, or nothing.
    QString (*run)(DocumentSession&, const ToolManager&);
};

QString wordsOf(const Result<void>& result) {
    return result ? QString() : asSentence(result.error().message);
}

QString wordsOf(const Result<QString>& result) {
    return result ? *result : asSentence(result.error().message);
}

template <void (*kRun)(DocumentSession&)>
QString always(DocumentSession& session, const ToolManager&) {
    kRun(session);
    return {};
}

template <Result<void> (*kRun)(DocumentSession&)>
QString perhaps(DocumentSession& session, const ToolManager&) {
    return wordsOf(kRun(session));
}

template <Result<QString> (*kRun)(DocumentSession&)>
QString perhaps(DocumentSession& session, const ToolManager&) {
    return wordsOf(kRun(session));
}

template <PatchFlag kFlag, bool kOn>
QString flag(DocumentSession& session, const ToolManager&) {
    return wordsOf(setFlag(session, kFlag, kOn));
}

template <PatchFlag kFlag>
QString clear(DocumentSession& session, const ToolManager&) {
    return wordsOf(clearFlag(session, kFlag));
}

template <bool kOn>
QString feature(DocumentSession& session, const ToolManager&) {
    return wordsOf(setFeature(session, kOn));
}

QString similar(DocumentSession& session, const ToolManager& tools) {
    selectSimilar(session, tools.options().wand);
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
    SessionAction{ActionId::RefitColours, kPatches | kPhoto, perhaps<refitColours>},
    SessionAction{ActionId::Hide, kPatches, flag<PatchFlag::Hidden, true>},
    SessionAction{ActionId::ShowAll, kHidden, clear<PatchFlag::Hidden>},
    SessionAction{ActionId::Lock, kPatches, flag<PatchFlag::Locked, true>},
    SessionAction{ActionId::UnlockAll, kLocked, clear<PatchFlag::Locked>},
    SessionAction{ActionId::CutOut, kOpaque, flag<PatchFlag::CutOut, true>},
    SessionAction{ActionId::FillIn, kCutOut, flag<PatchFlag::CutOut, false>},
    SessionAction{ActionId::SplitPatches, kPatches, perhaps<splitPatches>},
    SessionAction{ActionId::SplitCurves, kCurves, perhaps<splitCurves>},
    SessionAction{ActionId::MergeCurves, kCurves, perhaps<mergeCurves>},
    SessionAction{ActionId::SnapToFeature, kCurves | kPhoto, perhaps<snapToFeature>},
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
    mesh.forEachPatch([&](PatchId p) {
        const PatchAttributes& attributes = mesh.attributes(p);
        if (attributes.hidden) found |= kHidden;
        if (attributes.locked) found |= kLocked;
    });
    for (const PatchId p : selection.patches()) found |= mesh.attributes(p).cutOut ? kCutOut : kOpaque;
    for (const EdgeId e : selection.curves()) found |= mesh.curve(e).feature ? kFeature : kPlain;
    return found;
}

}  // namespace

void connectSessionActions(const ActionTable& actions, QObject* receiver,
                           std::function<DocumentSession*()> session, const ToolManager& tools,
                           std::function<void(const QString&)> say) {
    for (const SessionAction& action : kSessionActions)
        QObject::connect(actions[action.id], &QAction::triggered, receiver, [=, &tools] {
            DocumentSession* current = session();
            if (!current || !current->hasMesh()) return;
            // Splits, merges and fits of very many patches take seconds.
            QGuiApplication::setOverrideCursor(Qt::WaitCursor);
            const QString words = action.run(*current, tools);
            QGuiApplication::restoreOverrideCursor();
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
