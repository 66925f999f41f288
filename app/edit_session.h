// One gesture on a document: shown as it goes, undone as one step.
#pragma once

#include <QPointer>
#include <QString>
#include <functional>

#include "app/document_session.h"
#include "core/base/result.h"

namespace tessera {

// Changes a mesh in place. An error leaves the document as it was before; what it says is for a person.
using MeshEdit = std::function<Result<Touched>(PatchMesh&)>;

// At most one is open on a document. Until it is closed, by commit(), cancel() or its end, undo, saves,
// autosaves and results of jobs wait (DocumentSession::whenIdle). Where the document goes first, the rest is
// without effect.
class EditSession {
  public:
    EditSession(DocumentSession& session, QString text);
    EditSession(const EditSession&) = delete;
    EditSession& operator=(const EditSession&) = delete;
    // Gives back the start state where nothing was committed.
    ~EditSession() { cancel(); }

    bool open() const { return mOpen && mSession; }
    const QString& text() const { return mText; }
    // The mesh as it was when the session was opened.
    const PatchMesh& start() const { return mStart; }
    // What preview() has changed of the start state.
    const Touched& touched() const { return mTouched; }

    // Shows `edit` of the start state, not of the preview before. Where it fails the start state is shown.
    Result<void> preview(const MeshEdit& edit);
    // Makes what is shown one step of the history; none where it is the start state.
    void commit();
    void cancel();

  private:
    // Puts `mesh`, which differs from the start state by `touched`, in the place of the preview before.
    void show(PatchMesh mesh, Touched touched);
    void close();

    QPointer<DocumentSession> mSession;
    QString mText;
    PatchMesh mStart;
    Touched mTouched;
    bool mOpen = true;
};

// An edit of one go, as one step named `text`; none where it touches nothing. Refused while an EditSession is
// open. Returns what was touched.
Result<Touched> applyEdit(DocumentSession& session, const QString& text, const MeshEdit& edit);

// An edit that is not made, for a reason in the user's words (Usage).
tl::unexpected<Error> refused(const QString& why);
// The refusal of what cannot be done while an EditSession is open.
tl::unexpected<Error> refusedMeanwhile();

// What edits of the selection are about; a refusal where there is none.
Result<PatchSet> selectedPatches(const DocumentSession& session);
Result<std::vector<EdgeId>> selectedCurves(const DocumentSession& session);

// A step that changes other parts of the document than its mesh; `change` says which. Refused while an
// EditSession is open.
Result<void> applyToDocument(DocumentSession& session, const QString& text, const Change& change,
                             const std::function<void(Document&)>& edit);

}  // namespace tessera
