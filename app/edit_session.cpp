// See edit_session.h.
#include "app/edit_session.h"

#include <algorithm>
#include <utility>

#include "core/base/check.h"

namespace tessera {

namespace {

template <class Id>
std::vector<Id> unitedIds(const std::vector<Id>& a, const std::vector<Id>& b) {
    std::vector<Id> ids;
    ids.reserve(a.size() + b.size());
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(ids));
    return ids;
}

void push(DocumentSession& session, const QString& text, PatchMesh mesh, const Touched& touched) {
    Document after = session.document();
    after.mesh = std::move(mesh);
    after.markEdited();
    session.history().push(EditCommand(session, text, std::move(after), {.touched = touched}));
}

}  // namespace

Touched united(const Touched& a, const Touched& b) {
    return {.vertices = unitedIds(a.vertices, b.vertices),
            .edges = unitedIds(a.edges, b.edges),
            .patches = unitedIds(a.patches, b.patches),
            .topology = a.topology || b.topology};
}

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
    if (!Change{.touched = mTouched}.mesh()) return cancel();
    PatchMesh mesh = mSession->document().mesh;
    // Nobody is told: the step that follows brings back what is shown now.
    mSession->mDocument.mesh = mStart;
    close();
    push(*mSession, mText, std::move(mesh), mTouched);
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
    if (session.editing())
        return failure(ErrorCode::Usage, "another change is under way; finish it and try again");
    PatchMesh mesh = session.document().mesh;
    Result<Touched> touched = edit(mesh);
    if (touched && Change{.touched = *touched}.mesh()) push(session, text, std::move(mesh), *touched);
    return touched;
}

}  // namespace tessera
