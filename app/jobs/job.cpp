// See job.h.
#include "app/jobs/job.h"

#include <QFutureWatcher>
#include <QPromise>
#include <QtConcurrentRun>
#include <exception>
#include <new>

#include "core/base/parallel.h"

namespace tessera {

namespace {

// Progress travels as an integer with a text, which is what QPromise hands from thread to thread.
constexpr int kProgressSteps = 10000;

// Set and read on the UI thread.
int gThreadLimit = 0;

}  // namespace

Job::Job(JobKind kind, QString title, QObject* parent)
    : QObject(parent), mKind(kind), mTitle(std::move(title)) {}

void Job::setThreadLimit(int threads) {
    gThreadLimit = threads;
}

Job::~Job() {
    stop();
}

std::optional<double> Job::secondsLeft() const {
    constexpr double kLeastSeconds = 2, kLeastFraction = .05;
    const double seconds = double(mSinceStart.isValid() ? mSinceStart.elapsed() : 0) / 1000;
    if (seconds < kLeastSeconds || mFraction < kLeastFraction) return {};
    return seconds * (1 - mFraction) / mFraction;
}

void Job::startTask(std::function<void(Progress&)> task, std::function<void()> done) {
    mSinceStart.start();
    using Watcher = QFutureWatcher<void>;
    auto* watcher = new Watcher(this);
    connect(watcher, &Watcher::progressValueChanged, this,
            [this, watcher](int value) { showProgress(value, watcher->progressText()); });
    connect(watcher, &Watcher::finished, this, [this, done = std::move(done)] {
        done();
        end();
    });
    const auto run = [task = std::move(task), token = mStop.get_token(),
                      threads = gThreadLimit](QPromise<void>& promise) {
        promise.setProgressRange(0, kProgressSteps);
        Progress progress(token, [&promise](std::string_view stage, double, double total) {
            // From 1: QPromise drops the text that comes with the value it already has.
            promise.setProgressValueAndText(1 + int(total * (kProgressSteps - 1)),
                                            QString::fromUtf8(stage.data(), qsizetype(stage.size())));
        });
        if (threads == 0) return task(progress);
        withThreads(threads, [&] { task(progress); });
    };
    watcher->setFuture(QtConcurrent::run(run));
}

void Job::showProgress(int value, const QString& stage) {
    mStage = stage;
    mFraction = double(value) / kProgressSteps;
    emit progressed();
}

void Job::end() {
    emit finished();
    deleteLater();
}

Error Job::translateException() {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        return {ErrorCode::Internal,
                "There is not enough memory for this; choose a smaller size or close other programs."};
    } catch (const std::exception& e) {
        return {ErrorCode::Internal, std::string("Something went wrong inside Tessera: ") + e.what() + "."};
    } catch (...) {
        return {ErrorCode::Internal, "Something went wrong inside Tessera."};
    }
}

}  // namespace tessera
