// See document_session.h.
#include "app/document_session.h"

#include <QDir>
#include <QFileInfo>
#include <QPointer>
#include <utility>

namespace tessera {

DocumentSession::DocumentSession(Document document, Photo photo, QString path, QObject* parent)
    : QObject(parent),
      mDocument(std::move(document)),
      mPhoto(std::move(photo)),
      mPath(std::move(path)),
      mHistory(*this),
      mMarks(mDocument.mesh) {}

int DocumentSession::width() const {
    return hasMesh() ? mDocument.mesh.width() : mPhoto.image ? mPhoto.image->width() : 0;
}

int DocumentSession::height() const {
    return hasMesh() ? mDocument.mesh.height() : mPhoto.image ? mPhoto.image->height() : 0;
}

bool DocumentSession::hasAlpha() const {
    if (!hasMesh()) return mPhoto.image && mPhoto.image->hasAlpha();
    return mMarks.leavesHoles() || mDocument.mesh.channels() == 4;
}

QString DocumentSession::displayName() const {
    return QFileInfo(mPath.isEmpty() ? mPhoto.path : mPath).fileName();
}

QString DocumentSession::suggestedPath(const QString& suffix) const {
    const QFileInfo origin(mPath.isEmpty() ? mPhoto.path : mPath);
    const QString path = origin.dir().filePath(origin.completeBaseName() + '.' + suffix);
    // Whoever takes what is proposed shall not replace the photo.
    if (path.compare(mPhoto.path, Qt::CaseInsensitive) != 0) return path;
    return origin.dir().filePath(tr("%1-vector").arg(origin.completeBaseName()) + '.' + suffix);
}

void DocumentSession::markSaved(uint64_t revision, const QString& path, std::optional<double> colourStep) {
    mSavedRevision = revision;
    mPath = path;
    // Kept for ever, as the format asks; a state that has moved on meanwhile chooses its own at its first
    // saving.
    if (revision == mRevision) mDocument.colourStep = colourStep;
    emit changed({.saved = true});
    emit mHistory.changed();
}

void DocumentSession::markUnsaved() {
    mSavedRevision = 0;
    emit changed({.saved = true});
    emit mHistory.changed();
}

void DocumentSession::relinkPhoto(Photo photo, SourceInfo source) {
    Document after = mDocument;
    after.embeddedSource = photo.bytes;
    if (source.sha256 != after.source.sha256) after.difference.reset();
    after.source = std::move(source);
    mHistory.push(
        EditCommand(*this, tr("Relink Photo"), std::move(after), {.photo = true}, std::move(photo)));
}

void DocumentSession::swapState(Document& document, uint64_t& revision, std::optional<Photo>& photo,
                                const Change& change) {
    std::swap(mDocument, document);
    std::swap(mRevision, revision);
    if (photo) std::swap(mPhoto, *photo);
    announce(document.mesh, change);
}

void DocumentSession::showPreview(PatchMesh mesh, const Change& change) {
    std::swap(mDocument.mesh, mesh);
    announce(mesh, change);
}

void DocumentSession::announce(const PatchMesh& before, const Change& change) {
    if (change.mesh()) {
        mIndex.follow(mDocument.mesh, change);
        if (change.replaced || change.touched.topology)
            mMarks = PatchMarks(mDocument.mesh);
        else
            mMarks.update(mDocument.mesh, change.touched.patches);
        mSelection.follow(before, mDocument.mesh, change);
    }
    emit changed(change);
}

void DocumentSession::setEditing(bool editing) {
    mEditing = editing;
    emit editingChanged();
    // Not from here: whoever closes an EditSession is in the middle of something.
    if (!mEditing && !mWaiting.empty())
        QMetaObject::invokeMethod(this, &DocumentSession::runWaiting, Qt::QueuedConnection);
}

void DocumentSession::retire() {
    mRetired = true;
    mWaiting.clear();
}

void DocumentSession::whenIdle(std::function<void()> work) {
    if (mRetired) return;
    // After what waits already, even if nothing is in its way any more.
    if (!mEditing && mWaiting.empty()) return work();
    mWaiting.push_back(std::move(work));
}

void DocumentSession::runWaiting() {
    const QPointer<DocumentSession> self = this;  // work may close the document
    while (self && !mEditing && !mWaiting.empty()) {
        const std::function<void()> work = std::move(mWaiting.front());
        mWaiting.pop_front();
        work();
    }
}

}  // namespace tessera
