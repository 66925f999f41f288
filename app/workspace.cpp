// See workspace.h.
#include "app/workspace.h"

#include <QFileInfo>
#include <QPointer>
#include <algorithm>

#include "app/file_service.h"
#include "app/jobs/open_job.h"
#include "app/jobs/save_job.h"

namespace tessera {

QString asSentence(const std::string& text) {
    QString sentence = QString::fromStdString(text).trimmed();
    if (sentence.isEmpty()) return sentence;
    sentence[0] = sentence[0].toUpper();
    return sentence.endsWith('.') ? sentence : sentence + '.';
}

Workspace::Workspace(QObject* parent) : QObject(parent) {}

Workspace::~Workspace() {
    // Before the session that they would report to.
    const QList<Job*> jobs = std::exchange(mJobs, {});
    for (Job* job : jobs) {
        job->disconnect(this);
        delete job;
    }
}

void Workspace::open(const QString& path) {
    stopAll(JobKind::Open);
    Job* job = startOpenJob(this, path, [this, path](Result<OpenedFile> opened) {
        if (opened)
            adopt(std::move(*opened), path);
        else
            report(opened.error());
    });
    track(job);
}

void Workspace::adopt(OpenedFile opened, const QString& path) {
    stopAll(JobKind::Vectorize);
    DocumentSession* previous = mSession;
    mSession = new DocumentSession(std::move(opened.document), std::move(opened.photo),
                                   std::move(opened.path), std::move(opened.photoPath), this);
    emit sessionChanged();
    emit fileUsed(path);
    delete previous;
}

bool Workspace::canVectorize() const {
    return mSession && mSession->photo().image && !running(JobKind::Vectorize);
}

void Workspace::vectorize(const VectorizeSettings& settings) {
    if (!canVectorize()) return;
    const QPointer<DocumentSession> session = mSession;
    const uint64_t revision = mSession->revision();
    Job* job = startVectorizeJob(this, mSession->displayName(), mSession->photo().image, settings,
                                 [this, session, revision, settings](Result<Vectorized> vectorized) {
                                     if (!session || session != mSession) return;
                                     if (vectorized)
                                         applyVectorized(revision, settings, std::move(*vectorized));
                                     else
                                         report(vectorized.error());
                                 });
    track(job);
}

void Workspace::applyVectorized(uint64_t revision, const VectorizeSettings& settings, Vectorized vectorized) {
    Document after = mSession->document();
    after.mesh = std::move(vectorized.result.mesh);
    after.markEdited();
    after.colourStep.reset();
    after.settings = settings;
    after.report = std::move(vectorized.result.report);
    after.difference = vectorized.difference;
    const QString shortfall = asSentence(after.report.shortfall);
    const QPointer<DocumentSession> session = mSession;
    const auto apply = [session, after = std::move(after)] {
        if (!session) return;
        session->whenIdle([session, after] {
            session->history().push(EditCommand(*session, tr("Vectorize"), after, {.replaced = true}));
        });
    };
    if (mSession->revision() != revision) {
        emit said({.kind = Message::Kind::Info,
                   .text = tr("The document has changed since this vectorization was started."),
                   .actionText = tr("Use It Anyway"),
                   .action = apply});
        return;
    }
    apply();
    if (!shortfall.isEmpty()) emit said({.kind = Message::Kind::Info, .text = shortfall});
}

void Workspace::save(const QString& path, bool embedPhoto, std::function<void()> then) {
    if (!mSession || !mSession->hasMesh()) return;
    if (Job* job = find(JobKind::Save)) {
        // The one that runs may hold an older state: look again when it has ended.
        connect(job, &Job::finished, this, [this, path, embedPhoto, then = std::move(then)] {
            if (!mSession) return;
            if (mSession->modified() || mSession->path() != path) return save(path, embedPhoto, then);
            if (then) then();
        });
        return;
    }
    Document snapshot = mSession->document();
    if (!embedPhoto) snapshot.embeddedSource.reset();
    const QPointer<DocumentSession> session = mSession;
    const uint64_t revision = mSession->revision();
    Job* job = startSaveJob(this, std::move(snapshot), path,
                            [this, session, revision, path, then = std::move(then)](Result<Saved> saved) {
                                if (!saved) return report(saved.error());
                                emit fileUsed(path);
                                if (session) session->markSaved(revision, path, saved->colourStep);
                                if (then) then();
                            });
    track(job);
}

void Workspace::exportPicture(const ExportRequest& request) {
    if (!mSession || !mSession->hasMesh() || running(JobKind::Export)) return;
    Job* job = startExportJob(
        this, mSession->document().mesh, request, [this, path = request.path](Result<Exported> exported) {
            if (!exported) return report(exported.error());
            emit said(
                {.kind = Message::Kind::Info, .text = tr("Exported “%1”.").arg(QFileInfo(path).fileName())});
        });
    track(job);
}

Job* Workspace::find(JobKind kind) const {
    const auto job =
        std::find_if(mJobs.begin(), mJobs.end(), [&](const Job* j) { return j->kind() == kind; });
    return job == mJobs.end() ? nullptr : *job;
}

void Workspace::cancel() {
    if (Job* job = currentJob(); job && job->kind() != JobKind::Save) job->stop();
    emit jobChanged();
}

void Workspace::track(Job* job) {
    mJobs.append(job);
    connect(job, &Job::progressed, this, &Workspace::jobChanged);
    connect(job, &Job::finished, this, [this, job] {
        mJobs.removeOne(job);
        emit jobChanged();
    });
    emit jobChanged();
}

void Workspace::stopAll(JobKind kind) {
    const QList<Job*> jobs = mJobs;
    for (Job* job : jobs) {
        if (job->kind() != kind) continue;
        mJobs.removeOne(job);
        job->disconnect(this);
        delete job;  // drops its result too
    }
    emit jobChanged();
}

void Workspace::report(const Error& error) {
    if (error.code == ErrorCode::Stopped) return;
    emit said({.kind = Message::Kind::Error, .text = asSentence(error.message)});
}

}  // namespace tessera
