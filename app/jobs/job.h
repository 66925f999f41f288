// The one wrapper around work off the UI thread: copy in, Result out, a stop request, progress on the UI
// thread.
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace tessera {

enum class JobKind { Open, Relink, Drafts, Vectorize, Save, Autosave, Export, Copy, Edit, Render, Palette };

// One piece of work on the global thread pool. Lives on the thread that made it, and calls back only there.
// Destroying it asks the work to stop and drops its result, so that a job whose owner is gone changes
// nothing; the work itself must therefore own (or share) everything that it reads.
class Job : public QObject {
    Q_OBJECT

  public:
    // `title` says to a person what is going on: "Vectorizing photo.png".
    Job(JobKind kind, QString title, QObject* parent);
    ~Job() override;

    JobKind kind() const { return mKind; }
    const QString& title() const { return mTitle; }
    // The stage that the work is in, empty before the first, and the fraction of the whole, 0..1.
    const QString& stage() const { return mStage; }
    double fraction() const { return mFraction; }
    bool stopRequested() const { return mStop.stop_requested(); }
    // As long as it has taken so far for what is done; none before there is enough to tell by.
    std::optional<double> secondsLeft() const;

    // How many threads the work of jobs started from now on may use each; 0 is one for each core.
    static void setThreadLimit(int threads);

    // Asks the work to stop. Returns at once; the job then ends with ErrorCode::Stopped.
    void stop() { mStop.request_stop(); }

    // Starts `work` on a worker; `deliver` gets what it returned, on this thread, and then the job deletes
    // itself. A thrown exception arrives as an Internal error. To be called once.
    template <class T>
    void start(std::function<Result<T>(Progress&)> work, std::function<void(Result<T>)> deliver);

  signals:
    void progressed();
    // After the result has been delivered.
    void finished();

  private:
    // `task` runs on a worker and throws nothing; then `done` on this thread.
    void startTask(std::function<void(Progress&)> task, std::function<void()> done);
    void showProgress(int value, const QString& stage);
    void end();
    // The Error of the exception in flight; to be called in a handler.
    static Error translateException();

    JobKind mKind;
    QString mTitle;
    QString mStage;
    double mFraction = 0;
    QElapsedTimer mSinceStart;
    std::stop_source mStop;
};

template <class T>
void Job::start(std::function<Result<T>(Progress&)> work, std::function<void(Result<T>)> deliver) {
    // The result goes by a box of its own: QFuture::takeResult() resets the future's state, which the
    // promise, ending a moment later on the worker, then takes for unfinished and reports as finished once
    // more (Qt 6.4).
    const auto box = std::make_shared<std::optional<Result<T>>>();
    startTask(
        [work = std::move(work), box](Progress& progress) {
            try {
                box->emplace(work(progress));
            } catch (...) {
                box->emplace(tl::unexpected<Error>(translateException()));
            }
        },
        [this, deliver = std::move(deliver), box] {
            // It may have been done by the time that it was asked to stop.
            deliver(stopRequested() && box->value() ? Result<T>(stopped()) : std::move(**box));
        });
}

}  // namespace tessera
