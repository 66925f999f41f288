// One open document: its value, the photo it was made from, its history, and what has been saved of it.
#pragma once

#include <QObject>
#include <QString>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "app/change.h"
#include "app/history.h"
#include "app/mesh_index.h"
#include "app/patch_marks.h"
#include "app/photo.h"
#include "app/selection.h"
#include "core/document/document.h"

namespace tessera {

// Lives on the UI thread. A revision, above 0, names one state of the document: a command takes it to a new
// one, undoing it brings back the old one. Jobs remember the revision that they started from.
class DocumentSession : public QObject {
    Q_OBJECT

  public:
    // `path` is the .tessera file; empty for a photo that was never saved.
    DocumentSession(Document document, Photo photo, QString path, QObject* parent = nullptr);

    const Document& document() const { return mDocument; }
    const Photo& photo() const { return mPhoto; }
    bool hasMesh() const { return mDocument.mesh.patchCount() > 0; }
    // The picture's size: of the mesh, or of the photo before there is one.
    int width() const;
    int height() const;
    bool hasAlpha() const;

    const QString& path() const { return mPath; }
    const QString& photoPath() const { return mPhoto.path; }
    // What the window calls it: the file's name, or the photo's.
    QString displayName() const;
    // Where a dialog should start, and under which name: beside the photo or the document, and never the
    // photo's own.
    QString suggestedPath(const QString& suffix) const;

    uint64_t revision() const { return mRevision; }
    uint64_t savedRevision() const { return mSavedRevision; }
    bool modified() const { return mRevision != mSavedRevision; }
    History& history() { return mHistory; }
    const History& history() const { return mHistory; }

    Selection& selection() { return mSelection; }
    const Selection& selection() const { return mSelection; }
    // Of the mesh as it is shown now; references hold until the next change.
    const PatchQuery& query() { return mIndex.query(mDocument.mesh); }
    const PatchColours& colours() { return mIndex.colours(mDocument.mesh); }
    const PatchMarks& marks() const { return mMarks; }

    // Whether an EditSession is open: the document then is a preview, without a revision of its own.
    bool editing() const { return mEditing; }
    // Runs `work` now, or as soon as no EditSession is open (from the event loop, in the order in which it
    // was asked for). Not at all where the session is retired first.
    void whenIdle(std::function<void()> work);
    // The document has been closed: what waits is dropped, and so is all that comes later.
    void retire();

    // Tells the session that `revision` is now in the file at `path`, with the step to which its colours were
    // rounded.
    void markSaved(uint64_t revision, const QString& path, std::optional<double> colourStep);
    // No state of the session is in a file.
    void markUnsaved();
    // The photo has been found, or another one takes its place: a step, after which the document says where
    // it is from and embeds it. No EditSession is open.
    void relinkPhoto(Photo photo, SourceInfo source);

  signals:
    void changed(const tessera::Change& change);
    // An EditSession has been opened or closed.
    void editingChanged();

  private:
    friend class EditCommand;
    friend class EditSession;

    uint64_t newRevision() { return ++mLastRevision; }
    // Exchanges the document and its revision with `document` and `revision`, and the photo with `photo`, if
    // there is one.
    void swapState(Document& document, uint64_t& revision, std::optional<Photo>& photo, const Change& change);
    void showPreview(PatchMesh mesh, const Change& change);
    void announce(const PatchMesh& before, const Change& change);
    void setEditing(bool editing);
    void runWaiting();

    Document mDocument;
    Photo mPhoto;
    QString mPath;
    uint64_t mLastRevision = 1;
    uint64_t mRevision = 1;
    uint64_t mSavedRevision = 1;
    bool mEditing = false;
    bool mRetired = false;
    std::deque<std::function<void()>> mWaiting;
    History mHistory;
    Selection mSelection;
    MeshIndex mIndex;
    PatchMarks mMarks;
};

}  // namespace tessera
