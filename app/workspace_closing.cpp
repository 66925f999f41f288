// The part of the workspace that closes documents: what is asked first, what is waited for, and what goes.
#include <algorithm>
#include <utility>

#include "app/workspace.h"

namespace tessera {

namespace {

// The work on a document that would be lost with it. A save is waited for; all else can be had again.
constexpr auto kWorkOnDocument = {JobKind::Vectorize, JobKind::Edit};

QStringList titlesOf(const QList<Job*>& jobs) {
    QStringList titles;
    for (const Job* job : jobs) titles.append(job->title());
    return titles;
}

}  // namespace

void Workspace::close(DocumentSession* session, const CloseQuestions& ask, std::function<void(bool)> then) {
    const auto closing = std::make_shared<const Closing>(Closing{session, ask, std::move(then)});
    const ClosingPtr older = std::exchange(mClosing[session], closing);
    if (older && older->then) older->then(false);
    if (stands(closing)) askAboutWork(closing);
}

void Workspace::askAboutWork(const ClosingPtr& closing) {
    if (!stands(closing)) return;
    if (const QList<Job*> work = jobs(kWorkOnDocument, closing->session); !work.isEmpty()) {
        const RunningAnswer answer = closing->ask.running(titlesOf(work));
        if (answer == RunningAnswer::Cancel) return finish(closing, false);
        if (answer == RunningAnswer::Wait)
            // It may have ended while the question stood.
            return afterAll(jobs(kWorkOnDocument, closing->session),
                            [this, closing] { askAboutWork(closing); });
        for (const JobKind kind : kWorkOnDocument) stopAll(kind, closing->session);
    }
    closing->session->whenIdle([this, closing] { askAboutChanges(closing); });
}

void Workspace::askAboutChanges(const ClosingPtr& closing) {
    if (!stands(closing)) return;
    DocumentSession* const session = closing->session;
    if (Job* save = find(JobKind::Save, session))
        // It may make the question needless.
        return afterAll({save}, [this, closing] { askAboutWork(closing); });
    if (session->modified()) {
        const CloseAnswer answer = closing->ask.unsaved(*session);
        if (answer.kind == CloseAnswer::Kind::Cancel) return finish(closing, false);
        if (answer.kind == CloseAnswer::Kind::Save) {
            const QString path = answer.path.isEmpty() ? session->path() : answer.path;
            if (path.isEmpty()) return finish(closing, false);
            return save(session, path, answer.embedPhoto, [this, closing](bool written) {
                written ? askAboutWork(closing) : finish(closing, false);
            });
        }
    }
    if (!stands(closing)) return;
    remove(session);
    if (closing->then) closing->then(true);
}

void Workspace::finish(const ClosingPtr& closing, bool closed) {
    if (!stands(closing)) return;  // has been told already
    mClosing.remove(closing->session);
    if (closing->then) closing->then(closed);
}

void Workspace::closeAll(const CloseQuestions& ask, std::function<void(bool)> then) {
    const uint64_t call = ++mClosingAll;
    if (const QList<Job*> exports = jobs({JobKind::Export}, nullptr); !exports.isEmpty()) {
        const RunningAnswer answer = ask.running(titlesOf(exports));
        if (answer == RunningAnswer::Cancel) return then(false);
        if (answer == RunningAnswer::Wait)
            return afterAll(jobs({JobKind::Export}, nullptr), [this, call, ask, then = std::move(then)] {
                call == mClosingAll ? closeAll(ask, then) : then(false);
            });
        for (const Job* job : jobs({JobKind::Export}, nullptr)) drop(job);
    }
    closeNext(ask, std::move(then));
}

void Workspace::closeNext(const CloseQuestions& ask, std::function<void(bool)> then) {
    if (mSessions.isEmpty()) return then(true);
    close(mSessions.last(), ask,
          [this, ask, then = std::move(then)](bool closed) { closed ? closeNext(ask, then) : then(false); });
}

void Workspace::remove(DocumentSession* session) {
    mClosing.remove(session);
    mLastExports.remove(session);
    session->retire();
    for (const JobKind kind : {JobKind::Edit, JobKind::Vectorize, JobKind::Relink, JobKind::Drafts})
        stopAll(kind, session);
    const qsizetype at = mSessions.indexOf(session);
    mSessions.removeAt(at);
    // The neighbour on the right takes its place, or else the one on the left.
    if (session == mCurrent)
        setCurrent(mSessions.isEmpty() ? nullptr : mSessions[std::min(at, mSessions.size() - 1)]);
    emit sessionClosed(session);
    // A later session could have the same address.
    for (RunningJob& running : mJobs)
        if (running.session == session) running.session = nullptr;
    session->deleteLater();
}

QList<Job*> Workspace::jobs(std::initializer_list<JobKind> kinds, const DocumentSession* session) const {
    QList<Job*> found;
    for (const RunningJob& running : mJobs)
        if (std::find(kinds.begin(), kinds.end(), running.job->kind()) != kinds.end() &&
            (!session || running.session == session))
            found.append(running.job);
    return found;
}

void Workspace::afterAll(const QList<Job*>& jobs, std::function<void()> then) {
    // From the event loop: what a job delivers may wait there too.
    const auto done = [this, then = std::move(then)] {
        QMetaObject::invokeMethod(this, then, Qt::QueuedConnection);
    };
    if (jobs.isEmpty()) return done();
    const auto left = std::make_shared<qsizetype>(jobs.size());
    for (Job* job : jobs)
        connect(job, &QObject::destroyed, this, [left, done] {
            if (--*left == 0) done();
        });
}

}  // namespace tessera
