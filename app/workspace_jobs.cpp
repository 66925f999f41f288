// The half of the workspace that works on the open documents: vectorizing, saving, exporting, and the list of
// jobs.
#include <QFileInfo>
#include <QLocale>
#include <algorithm>
#include <utility>

#include "app/jobs/draft_job.h"
#include "app/jobs/element_edit_job.h"
#include "app/jobs/save_job.h"
#include "app/selection_picture.h"
#include "app/workspace.h"
#include "core/image/image_io.h"

namespace tessera {

namespace {

// So many elements take less than a tenth of a second.
constexpr size_t kEditedAtOnce = 50;

}  // namespace

bool Workspace::canVectorize() const {
    return mCurrent && mCurrent->photo().image && !running(JobKind::Vectorize);
}

void Workspace::vectorize(const VectorizeSettings& settings, std::optional<double> meanError) {
    if (!canVectorize()) return;
    const QPointer<DocumentSession> session = mCurrent;
    const uint64_t revision = mCurrent->revision();
    Job* job =
        startVectorizeJob(this, mCurrent->displayName(), mCurrent->photo().image, settings, meanError,
                          [this, session, revision](Result<Vectorized> vectorized) {
                              if (!session) return;
                              if (!vectorized) return report(vectorized.error());
                              session->whenIdle([this, session, revision, result = std::move(*vectorized)] {
                                  applyVectorized(*session, revision, result);
                              });
                          });
    track(job, mCurrent);
}

void Workspace::buildDrafts(const VectorizeSettings& settings,
                            std::function<void(std::shared_ptr<const DraftLadder>)> then) {
    const QPointer<DocumentSession> session = mCurrent;
    Job* job = startLadderJob(
        this, mCurrent->displayName(), mCurrent->photo().image, settings,
        [this, session, then = std::move(then)](Result<std::shared_ptr<const DraftLadder>> ladder) {
            if (!session) return;
            if (!ladder) report(ladder.error());
            then(ladder ? std::move(*ladder) : nullptr);
        });
    track(job, mCurrent);
}

void Workspace::applyVectorized(DocumentSession& session, uint64_t revision, Vectorized vectorized) {
    Document after = session.document();
    const bool dropped = !after.selections.empty();
    after.mesh = std::move(vectorized.result.mesh);
    after.markEdited();
    after.fitted.reset();
    after.selections.clear();
    after.colourStep.reset();
    after.settings = std::move(vectorized.settings);
    after.report = std::move(vectorized.result.report);
    after.difference = vectorized.difference;
    QString remarks = asSentence(after.report.shortfall);
    if (dropped)
        remarks = (remarks + ' ' + tr("The stored selections belonged to the patches before and are gone."))
                      .trimmed();
    const QPointer<DocumentSession> target = &session;
    const auto apply = [target, after = std::move(after), dropped] {
        if (!target) return;
        target->whenIdle([target, after, dropped] {
            const Change change{.replaced = true, .selections = dropped};
            target->history().push(EditCommand(*target, tr("Vectorize"), after, change));
        });
    };
    if (session.revision() != revision) {
        emit said({.kind = Message::Kind::Info,
                   .text = tr("“%1” has changed since this vectorization of it was started.")
                               .arg(session.displayName()),
                   .actionText = tr("Use It Anyway"),
                   .action = apply,
                   .keep = true,
                   .about = &session});
        return;
    }
    apply();
    if (!remarks.isEmpty()) emit said({.kind = Message::Kind::Info, .text = remarks});
}

void Workspace::save(const QString& path, bool embedPhoto, std::function<void(bool)> then) {
    if (mCurrent) save(mCurrent, path, embedPhoto, std::move(then));
}

void Workspace::save(DocumentSession* session, const QString& path, bool embedPhoto,
                     std::function<void(bool)> then) {
    if (!session->hasMesh()) return;
    session->whenIdle([this, session, path, embedPhoto, then = std::move(then)] {
        if (const DocumentSession* other = sessionAt(path); other && other != session) {
            emit said({.kind = Message::Kind::Error,
                       .text = tr("“%1” is open in another tab; close it there, or save under another name.")
                                   .arg(QFileInfo(path).fileName())});
            if (then) then(false);
            return;
        }
        Job* const job = find(JobKind::Save, session);
        if (!job) return startSave(*session, path, embedPhoto, then);
        // The one that runs may hold an older state: look again when it has ended.
        const QPointer<DocumentSession> target = session;
        connect(job, &Job::finished, this, [this, target, path, embedPhoto, then] {
            if (!target) return;
            if (target->modified() || target->path() != path) return save(target, path, embedPhoto, then);
            if (then) then(true);
        });
    });
}

void Workspace::startSave(DocumentSession& session, const QString& path, bool embedPhoto,
                          std::function<void(bool)> then) {
    Document snapshot = session.document();
    if (session.photo().bytes) snapshot.embeddedSource = session.photo().bytes;
    const QPointer<DocumentSession> target = &session;
    const uint64_t revision = session.revision();
    Job* job = startSaveJob(this, std::move(snapshot), path, embedPhoto ? QString() : session.photoPath(),
                            [this, target, revision, path, then = std::move(then)](Result<Saved> written) {
                                if (!written) {
                                    report(written.error());
                                    if (then) then(false);
                                    return;
                                }
                                emit fileUsed(path);
                                if (target) {
                                    target->markSaved(revision, path, written->colourStep);
                                    emit saved(target);
                                }
                                if (then) then(true);
                            });
    track(job, &session, path);
}

bool Workspace::canExportAgain() const {
    return mCurrent && mCurrent->hasMesh() && mLastExports.contains(mCurrent) && !running(JobKind::Export);
}

void Workspace::exportAgain() {
    if (canExportAgain()) exportPicture(mLastExports.value(mCurrent));
}

void Workspace::exportPicture(const ExportRequest& request) {
    if (!mCurrent || !mCurrent->hasMesh() || running(JobKind::Export)) return;
    if (const auto format = pictureFormatFor(request.path.toStdString()); !format)
        return report(format.error());
    mLastExports[mCurrent] = request;
    const QPointer<DocumentSession> target = mCurrent;
    mCurrent->whenIdle([this, target, request] {
        Job* job = startExportJob(
            this, target->document().mesh, request, [this, path = request.path](Result<Exported> exported) {
                if (!exported) return report(exported.error());
                const QLocale locale;
                emit said(
                    {.text = tr("Exported “%1”, %2 × %3.")
                                 .arg(QFileInfo(path).fileName(), locale.toString(exported->size.width()),
                                      locale.toString(exported->size.height()))});
            });
        track(job, target);
    });
}

void Workspace::drawSelection(std::function<void(const QImage&)> then) {
    if (!mCurrent || !mCurrent->hasMesh()) return;
    for (const Job* job : jobs({JobKind::Copy}, nullptr)) drop(job);
    Job* job = startSelectionPictureJob(this, mCurrent->document().mesh, mCurrent->selection().patches(),
                                        [this, then = std::move(then)](Result<QImage> picture) {
                                            picture ? then(*picture) : report(picture.error());
                                        });
    track(job, mCurrent);
}

void Workspace::edit(const Result<ElementEdit>& edit) {
    if (!mCurrent) return;
    if (edit && edit->count > kEditedAtOnce && !mCurrent->editing())
        return startEdit(std::make_shared<EditSession>(*mCurrent, edit->text), *edit, {});
    const Result<QString> made = makeNow(*mCurrent, edit);
    const QString words = made ? *made : asSentence(made.error().message);
    if (!words.isEmpty()) emit said({.kind = Message::Kind::Info, .text = words});
}

void Workspace::finish(std::shared_ptr<EditSession> gesture, ElementEdit edit, EditThen then) {
    if (!mCurrent || edit.count <= kEditedAtOnce) return finishNow(std::move(gesture), edit, then);
    startEdit(std::move(gesture), std::move(edit), std::move(then));
}

void Workspace::startEdit(std::shared_ptr<EditSession> gesture, ElementEdit edit, EditThen then) {
    const QPointer<DocumentSession> target = mCurrent;
    const PatchMesh start = gesture->start();
    const auto deliver = [this, gesture = std::move(gesture), then = std::move(then), target,
                          text = edit.text](Result<EditedMesh> result) {
        gesture->cancel();
        if (!target) return;
        Result<Touched> touched = Touched{};
        if (result) {
            touched = applyEdit(*target, text, [&](PatchMesh& mesh) -> Result<Touched> {
                mesh = std::move(result->mesh);
                return std::move(result->edited.touched);
            });
            if (!result->edited.remark.isEmpty())
                emit said({.kind = Message::Kind::Info, .text = result->edited.remark});
        } else if (result.error().code != ErrorCode::Stopped) {
            emit said({.kind = Message::Kind::Info, .text = asSentence(result.error().message)});
        }
        if (then) then(touched.value_or(Touched{}));
    };
    track(startElementEditJob(this, start, std::move(edit), deliver), mCurrent);
}

Job* Workspace::find(JobKind kind, const DocumentSession* session) const {
    const auto found = std::find_if(mJobs.rbegin(), mJobs.rend(), [&](const RunningJob& running) {
        return running.job->kind() == kind && (kind == JobKind::Open || running.session == session);
    });
    return found == mJobs.rend() ? nullptr : found->job;
}

void Workspace::cancel() {
    Job* const job = currentJob();
    if (job && job->kind() != JobKind::Save && !job->stopRequested()) {
        job->stop();
        connect(job, &Job::finished, this,
                [this, job] { emit said({.text = tr("Cancelled: %1.").arg(job->title())}); });
    }
    emit jobChanged();
}

void Workspace::track(Job* job, const DocumentSession* session, const QString& path) {
    mJobs.append({job, session, path});
    connect(job, &Job::progressed, this, &Workspace::jobChanged);
    connect(job, &Job::finished, this, [this, job] {
        mJobs.removeIf([&](const RunningJob& running) { return running.job == job; });
        emit jobChanged();
    });
    emit jobChanged();
}

void Workspace::stopAll(JobKind kind, const DocumentSession* session) {
    for (const Job* job : jobs({kind}, session)) drop(job);
}

void Workspace::drop(const Job* job) {
    mJobs.removeIf([&](const RunningJob& running) { return running.job == job; });
    delete job;
    emit jobChanged();
}

void Workspace::report(const Error& error) {
    if (error.code == ErrorCode::Stopped) return;
    emit said({.kind = Message::Kind::Error, .text = asSentence(error.message)});
}

}  // namespace tessera
