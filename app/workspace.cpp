// See workspace.h. Vectorizing, saving and exporting are in workspace_jobs.cpp, closing in
// workspace_closing.cpp.
#include "app/workspace.h"

#include <QFileInfo>
#include <utility>

#include "app/file_service.h"
#include "app/jobs/open_job.h"

namespace tessera {

namespace {

// The one file that a path leads to, whether it is there yet or not.
QString fileAt(const QString& path) {
    const QFileInfo info(path);
    return info.exists() ? info.canonicalFilePath() : info.absoluteFilePath();
}

}  // namespace

Workspace::Workspace(QObject* parent) : QObject(parent) {}

Workspace::~Workspace() {
    // Before the sessions that they would report to.
    const QList<RunningJob> jobs = std::exchange(mJobs, {});
    for (const RunningJob& running : jobs) {
        running.job->disconnect(this);
        delete running.job;
    }
}

void Workspace::setCurrent(DocumentSession* session) {
    if (session == mCurrent) return;
    mCurrent = session;
    emit sessionChanged();
}

void Workspace::moveSession(int from, int to) {
    if (from == to || from < 0 || to < 0 || from >= mSessions.size() || to >= mSessions.size()) return;
    mSessions.move(from, to);
    emit sessionMoved(from, to);
}

void Workspace::open(const QString& path) {
    if (DocumentSession* session = sessionAt(path)) return setCurrent(session);
    const QString absolute = QFileInfo(path).absoluteFilePath();
    if (mOpening.contains(absolute)) return;
    mOpening.insert(absolute);
    const auto read = [path](Progress& progress) { return openFile(path, progress); };
    Job* job = startOpenJob(this, QFileInfo(path).fileName(), read,
                            [this, path, absolute](Result<OpenedFile> opened) {
                                mOpening.remove(absolute);
                                if (!opened) return report(opened.error());
                                adopt(std::move(*opened));
                                emit fileUsed(path);
                            });
    track(job, nullptr);
}

DocumentSession* Workspace::sessionAt(const QString& path) const {
    const QString file = fileAt(path);
    for (DocumentSession* session : mSessions) {
        if (!session->path().isEmpty() && fileAt(session->path()) == file) return session;
        for (const RunningJob& running : mJobs)
            if (running.session == session && !running.path.isEmpty() && fileAt(running.path) == file)
                return session;
    }
    return nullptr;
}

void Workspace::paste(const QImage& picture) {
    const auto read = [picture](Progress& progress) { return openPasted(picture, progress); };
    track(startOpenJob(this, tr("the pasted picture"), read,
                       [this](Result<OpenedFile> opened) {
                           if (!opened) return report(opened.error());
                           adopt(std::move(*opened));
                       }),
          nullptr);
}

void Workspace::openRecovered(const QString& dataPath, const QString& path, const QString& photoPath,
                              std::function<void(DocumentSession&)> adopted) {
    const auto read = [dataPath](Progress& progress) { return openFile(dataPath, progress); };
    const QString name = QFileInfo(path.isEmpty() ? photoPath : path).fileName();
    Job* job =
        startOpenJob(this, name, read, [=, this, adopted = std::move(adopted)](Result<OpenedFile> opened) {
            if (!opened) return report(opened.error());
            opened->path = path;
            opened->photo.path = photoPath;
            DocumentSession* session = adopt(std::move(*opened));
            session->markUnsaved();
            adopted(*session);
        });
    track(job, nullptr);
}

DocumentSession* Workspace::adopt(OpenedFile opened) {
    auto* session = new DocumentSession(std::move(opened.document), std::move(opened.photo),
                                        std::move(opened.path), this);
    session->history().setMemoryLimit(mHistoryLimit);
    mSessions.append(session);
    setCurrent(session);
    emit sessionAdded(session);
    return session;
}

void Workspace::relinkPhoto(const QString& path) {
    if (!mCurrent || find(JobKind::Relink, mCurrent)) return;
    const QPointer<DocumentSession> session = mCurrent;
    const auto read = [path](Progress& progress) { return openFile(path, progress); };
    Job* job = startOpenJob(
        this, QFileInfo(path).fileName(), read,
        [this, session, path](Result<OpenedFile> opened) {
            if (!opened) return report(opened.error());
            if (session) applyRelinked(*session, std::move(*opened), path);
        },
        JobKind::Relink);
    track(job, mCurrent);
}

void Workspace::applyRelinked(DocumentSession& session, OpenedFile opened, const QString& path) {
    const QString name = QFileInfo(path).fileName();
    const auto refuse = [&](const QString& why) { emit said({.kind = Message::Kind::Error, .text = why}); };
    if (!opened.path.isEmpty()) return refuse(tr("“%1” is a Tessera document; choose a picture.").arg(name));
    const Image& image = *opened.photo.image;
    if (session.hasMesh() && (image.width() != session.width() || image.height() != session.height()))
        return refuse(tr("“%1” has %2 × %3 pixels, the document %4 × %5; choose the picture that it was made "
                         "from.")
                          .arg(name)
                          .arg(image.width())
                          .arg(image.height())
                          .arg(session.width())
                          .arg(session.height()));
    const QPointer<DocumentSession> target = &session;
    const auto apply = [target, photo = opened.photo, source = opened.document.source] {
        if (target) target->whenIdle([target, photo, source] { target->relinkPhoto(photo, source); });
    };
    const std::string& known = session.document().source.sha256;
    if (known.empty() || known == opened.document.source.sha256) return apply();
    emit said(
        {.kind = Message::Kind::Info,
         .text = tr("“%1” is not the picture that “%2” was made from.").arg(name, session.displayName()),
         .actionText = tr("Use It Anyway"),
         .action = apply,
         .keep = true,
         .about = &session});
}

void Workspace::setHistoryLimit(size_t bytes) {
    mHistoryLimit = bytes;
    for (DocumentSession* session : std::as_const(mSessions)) session->history().setMemoryLimit(bytes);
}

}  // namespace tessera
