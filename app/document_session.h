// One open document: its value, the photo it was made from, its history, and what has been saved of it.
#pragma once

#include <QObject>
#include <QString>
#include <QUndoStack>
#include <memory>

#include "app/picture_pyramid.h"
#include "core/document/document.h"

namespace tessera {

// What a listener must look at again. One signal carries it, so that no listener sees half of a change.
struct Change {
    bool mesh = false;   // the patches (and with them report, settings, difference)
    bool saved = false;  // the path or the modified state
};

// The photo in the two forms in which it is used; both null where it is not known.
struct Photo {
    std::shared_ptr<const Image> image;
    std::shared_ptr<const PicturePyramid> pyramid;
};

// Lives on the UI thread. A revision names one state of the document: a command takes it to a new one,
// undoing it brings back the old one. Jobs remember the revision that they started from.
class DocumentSession : public QObject {
    Q_OBJECT

  public:
    // `path` is the .tessera file; empty for a photo that was never saved. `photoPath` is where the photo
    // came from.
    DocumentSession(Document document, Photo photo, QString path, QString photoPath,
                    QObject* parent = nullptr);

    const Document& document() const { return mDocument; }
    const Photo& photo() const { return mPhoto; }
    bool hasMesh() const { return mDocument.mesh.patchCount() > 0; }
    // The picture's size: of the mesh, or of the photo before there is one.
    int width() const;
    int height() const;
    bool hasAlpha() const;

    const QString& path() const { return mPath; }
    // What the window calls it: the file's name, or the photo's.
    QString displayName() const;
    // Where a dialog should start, and under which name: beside the photo or the document.
    QString suggestedPath(const QString& suffix) const;

    uint64_t revision() const { return mRevision; }
    bool modified() const { return mRevision != mSavedRevision; }
    QUndoStack& history() { return mHistory; }

    // Tells the session that `revision` is now in the file at `path`, with the step to which its colours were
    // rounded.
    void markSaved(uint64_t revision, const QString& path, std::optional<double> colourStep);

  signals:
    void changed(const tessera::Change& change);

  private:
    friend class ReplaceMesh;

    uint64_t newRevision() { return ++mLastRevision; }
    // Exchanges the document and its revision with `document` and `revision`.
    void swapState(Document& document, uint64_t& revision);

    Document mDocument;
    Photo mPhoto;
    QString mPath;
    QString mPhotoPath;
    uint64_t mLastRevision = 1;
    uint64_t mRevision = 1;
    uint64_t mSavedRevision = 1;
    QUndoStack mHistory;
};

}  // namespace tessera
