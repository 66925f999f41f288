// See edit_session.h.
#include "app/edit_session.h"

#include <utility>

#include "core/base/check.h"
#include "core/edit/split_merge.h"

namespace tessera {

namespace {

void push(DocumentSession& session, const QString& text, PatchMesh mesh, const Touched& touched) {
    Document after = session.document();
    if (!after.fitted) after.fitted = after.mesh;
    if (touched.topology) {
        for (NamedSelection& selection : after.selections)
            selection.patches = carriedOver(after.mesh, mesh, selection.patches);
        std::erase_if(after.selections, [](const NamedSelection& s) { return s.patches.empty(); });
    }
    after.mesh = std::move(mesh);
    after.markEdited();
    const Change change{.touched = touched, .selections = touched.topology};
    session.history().push(EditCommand(session, text, std::move(after), change));
}

}  // namespace

EditSession::EditSession(DocumentSession& session, QString text)
    : mSession(&session), mText(std::move(text)), mStart(session.document().mesh) {
    TESSERA_CHECK(!session.editing());
    session.setEditing(true);
}

Result<void> EditSession::preview(const MeshEdit& edit) {
    if (!open()) return {};
    PatchMesh mesh = mStart;
    Result<Touched> touched = edit(mesh);
    if (!touched) {
        show(mStart, {});
        return tl::unexpected<Error>(touched.error());
    }
    show(std::move(mesh), std::move(*touched));
    return {};
}

void EditSession::show(PatchMesh mesh, Touched touched) {
    // Elements that the preview before moved and this one does not are back where they were.
    Change change{.touched = united(mTouched, touched), .preview = true};
    mTouched = std::move(touched);
    if (change.mesh()) mSession->showPreview(std::move(mesh), change);
}

void EditSession::commit() {
    if (!open()) return;
    if (mTouched.empty()) return cancel();
    PatchMesh mesh = mSession->document().mesh;
    const Touched touched = mTouched;
    // Nobody is told, as the step that follows brings back what is shown now; but ids that come and go are
    // followed from state to state.
    if (touched.topology)
        show(mStart, {});
    else
        mSession->mDocument.mesh = mStart;
    close();
    push(*mSession, mText, std::move(mesh), touched);
}

void EditSession::cancel() {
    if (!open()) return;
    show(mStart, {});
    close();
}

void EditSession::close() {
    mOpen = false;
    mSession->setEditing(false);
}

Result<Touched> applyEdit(DocumentSession& session, const QString& text, const MeshEdit& edit) {
    if (session.editing()) return refusedMeanwhile();
    PatchMesh mesh = session.document().mesh;
    Result<Touched> touched = edit(mesh);
    if (touched && !touched->empty()) push(session, text, std::move(mesh), *touched);
    return touched;
}

tl::unexpected<Error> refused(const QString& why) {
    return failure(ErrorCode::Usage, why.toStdString());
}

tl::unexpected<Error> refusedMeanwhile() {
    return refused(QObject::tr("Another change is under way; finish it and try again."));
}

Result<PatchSet> selectedPatches(const DocumentSession& session) {
    if (session.selection().patches().empty()) return refused(QObject::tr("Select patches first."));
    return session.selection().patches();
}

Result<std::vector<EdgeId>> selectedCurves(const DocumentSession& session) {
    if (session.selection().curves().empty())
        return refused(QObject::tr("Select curves with the direct-selection tool first."));
    return session.selection().curves();
}

Result<void> applyToDocument(DocumentSession& session, const QString& text, const Change& change,
                             const std::function<void(Document&)>& edit) {
    if (session.editing()) return refusedMeanwhile();
    Document after = session.document();
    edit(after);
    session.history().push(EditCommand(session, text, std::move(after), change));
    return {};
}

}  // namespace tessera
