// What the window works on: the one open document and the jobs that read, make and write it. No widgets, so
// that the rules (what stops what, what is thrown away when) are in one place and testable.
#pragma once

#include <QList>
#include <QObject>
#include <functional>

#include "app/document_session.h"
#include "app/jobs/export_job.h"
#include "app/jobs/job.h"
#include "app/jobs/vectorize_job.h"
#include "core/vectorize/settings.h"

namespace tessera {

struct OpenedFile;

// Something to tell the user in one sentence. With an action, the sentence asks whether to do it.
struct Message {
    enum class Kind { Info, Error };
    Kind kind = Kind::Info;
    QString text = {};
    QString actionText = {};
    std::function<void()> action = {};
};

// Core's messages are clauses that a command line puts after "error: "; a window shows them as sentences.
QString asSentence(const std::string& text);

class Workspace : public QObject {
    Q_OBJECT

  public:
    explicit Workspace(QObject* parent = nullptr);
    ~Workspace() override;

    // Null until the first file has been opened.
    DocumentSession* session() const { return mSession; }

    // Reads the file; the open document stays until it has been read. A later open() replaces an earlier one
    // that is still reading. What runs on the open document is stopped when the new one takes its place.
    void open(const QString& path);
    // Needs a photo; does nothing while a vectorization is running. The result becomes one undoable step.
    void vectorize(const VectorizeSettings& settings);
    bool canVectorize() const;
    // Saves a snapshot of a document with patches, after a save that is still running; `then` runs after it
    // has been written, and not where that failed.
    void save(const QString& path, bool embedPhoto, std::function<void()> then = {});
    void exportPicture(const ExportRequest& request);

    // The job to show: the one started last that still runs, or null.
    Job* currentJob() const { return mJobs.isEmpty() ? nullptr : mJobs.last(); }
    bool running(JobKind kind) const { return find(kind); }
    // Asks the current job to stop, unless it is a save, which is short and wanted.
    void cancel();

  signals:
    // Another document is open.
    void sessionChanged();
    // A file has been opened from, or saved to, this path.
    void fileUsed(const QString& path);
    // Another job is the current one, or it has moved on.
    void jobChanged();
    void said(const tessera::Message& message);

  private:
    void adopt(OpenedFile opened, const QString& path);
    void applyVectorized(uint64_t revision, const VectorizeSettings& settings, Vectorized vectorized);
    Job* find(JobKind kind) const;
    void track(Job* job);
    void stopAll(JobKind kind);
    // Says the error, unless it is that the user stopped the job.
    void report(const Error& error);

    DocumentSession* mSession = nullptr;
    QList<Job*> mJobs;
};

}  // namespace tessera
