// What the window works on: the open documents and the jobs that read, make and write them. No widgets, so
// that the rules (what stops what, what is thrown away when) are in one place and testable.
#pragma once

#include <QHash>
#include <QImage>
#include <QList>
#include <QObject>
#include <QPointer>
#include <QSet>
#include <QStringList>
#include <functional>

#include "app/document_session.h"
#include "app/element_edits.h"
#include "app/jobs/export_job.h"
#include "app/jobs/job.h"
#include "app/jobs/vectorize_job.h"
#include "app/message.h"
#include "core/vectorize/draft_ladder.h"
#include "core/vectorize/settings.h"

namespace tessera {

struct OpenedFile;

// What to do with a document that has unsaved changes and is to be closed. To save one that has no path yet,
// `path` must say where.
struct CloseAnswer {
    enum class Kind { Save, Discard, Cancel };
    Kind kind = Kind::Cancel;
    QString path = {};
    bool embedPhoto = true;
};

// What to do with work that would be lost by closing: close when it is done, stop it, or do not close.
enum class RunningAnswer { Wait, Stop, Cancel };

// What a person is asked before closing loses something. Both are there.
struct CloseQuestions {
    // About a document with unsaved changes.
    std::function<CloseAnswer(DocumentSession&)> unsaved;
    // About jobs that still run, by their titles; at least one.
    std::function<RunningAnswer(const QStringList&)> running;
};

// Where no document is named, calls are about the current one. Results of jobs, saves and closing wait for
// the end of an open EditSession.
class Workspace : public QObject {
    Q_OBJECT

  public:
    explicit Workspace(QObject* parent = nullptr);
    ~Workspace() override;

    // In the order of the tabs.
    const QList<DocumentSession*>& sessions() const { return mSessions; }
    // The current one; null where none is open.
    DocumentSession* session() const { return mCurrent; }
    void setCurrent(DocumentSession* session);
    void moveSession(int from, int to);

    // Reads the file, then makes it the current document; one that is open already becomes it at once.
    void open(const QString& path);
    // A picture from the clipboard, as a new document.
    void paste(const QImage& picture);
    // A document that a run before this one left behind; `path` is where it was saved, if anywhere. It counts
    // as modified. `adopted` gets the session.
    void openRecovered(const QString& dataPath, const QString& path, const QString& photoPath,
                       std::function<void(DocumentSession&)> adopted);
    // Makes the picture in a file the photo of the document, as a step. Fails where it has another size; asks
    // where it is another picture than the document says that it is from.
    void relinkPhoto(const QString& path);

    // Closes after asking where running work or changes would be lost, and saving where the answer is so.
    // Exports of the document go on. `then` hears whether it was closed. A later call takes the place of one
    // that still waits (for a save, a gesture or running work), whose `then` hears false.
    void close(DocumentSession* session, const CloseQuestions& ask, std::function<void(bool)> then = {});
    // One after the other, until one is kept; before them, what is being exported is asked about.
    void closeAll(const CloseQuestions& ask, std::function<void(bool)> then);

    // Needs a photo; does nothing while a vectorization of it is running. The result becomes one undoable
    // step. With `meanError` (levels of 255) the patches are those that it takes, and not the settings'.
    void vectorize(const VectorizeSettings& settings, std::optional<double> meanError = {});
    bool canVectorize() const;
    // Builds the drafts of the current photo around the settings' number of patches; `then` hears of it
    // unless the document is closed first, and gets null where that failed or was stopped.
    void buildDrafts(const VectorizeSettings& settings,
                     std::function<void(std::shared_ptr<const DraftLadder>)> then);
    // Saves a snapshot of a document with patches, after a save that is still running; `then` hears whether
    // it has been written, after the message about it where it has not, unless the document is closed first.
    // Fails where another open document is the one in that file. Without `embedPhoto` the photo is left out
    // if its own file still holds it.
    void save(const QString& path, bool embedPhoto, std::function<void(bool)> then = {});
    void save(DocumentSession* session, const QString& path, bool embedPhoto, std::function<void(bool)> then);
    // Fails at once where no format is known for the path.
    void exportPicture(const ExportRequest& request);
    // The selected patches of the current document, or all of it, as a picture for the clipboard. `then`
    // hears of it unless that was stopped; a later call takes the place of one that is not done yet.
    void drawSelection(std::function<void(const QImage&)> then);
    // The last export of the current document, with what it is now.
    void exportAgain();
    bool canExportAgain() const;
    // Makes an edit of the current document one step: at once where it is small, else by a job, during which
    // an EditSession is open. Says what could not be edited, or why nothing could.
    void edit(const Result<ElementEdit>& edit);
    // Ends a gesture on the current document likewise (FinishGesture).
    void finish(std::shared_ptr<EditSession> gesture, ElementEdit edit, EditThen then);

    // Of all documents, those to come included.
    void setHistoryLimit(size_t bytes);

    // The job to show: the one started last that still runs, or null.
    Job* currentJob() const { return mJobs.isEmpty() ? nullptr : mJobs.last().job; }
    // The last job of this kind of the current document, or null; of kind Open: of all documents to come.
    const Job* running(JobKind kind) const { return find(kind, mCurrent); }
    // Asks the current job to stop, unless it is a save, which is short and wanted; it is said once it has.
    void cancel();

  signals:
    // Another document is the current one, or none. The one before is still there.
    void sessionChanged();
    // It is the current one already.
    void sessionAdded(tessera::DocumentSession* session);
    // For the last time; it goes when control is back in the event loop.
    void sessionClosed(tessera::DocumentSession* session);
    void sessionMoved(int from, int to);
    // A file has been opened from, or saved to, this path.
    void fileUsed(const QString& path);
    // A document is in its file as it was when the save began.
    void saved(tessera::DocumentSession* session);
    // Another job is the current one, or it has moved on.
    void jobChanged();
    void said(const tessera::Message& message);

  private:
    struct RunningJob {
        Job* job;
        const DocumentSession* session;  // null for Open
        QString path;                    // of a save: where to
    };

    struct Closing {
        DocumentSession* session;
        CloseQuestions ask;
        std::function<void(bool)> then;
    };
    using ClosingPtr = std::shared_ptr<const Closing>;

    // workspace_closing.cpp
    // Whether it is the latest wish for its document, which then is open.
    bool stands(const ClosingPtr& closing) const { return mClosing.value(closing->session) == closing; }
    void askAboutWork(const ClosingPtr& closing);
    void askAboutChanges(const ClosingPtr& closing);
    void finish(const ClosingPtr& closing, bool closed);
    void closeNext(const CloseQuestions& ask, std::function<void(bool)> then);
    // The jobs of these kinds; of this session, or of all where it is null.
    QList<Job*> jobs(std::initializer_list<JobKind> kinds, const DocumentSession* session) const;
    // Calls `then` once none of the jobs runs, not before control is back in the event loop.
    void afterAll(const QList<Job*>& jobs, std::function<void()> then);

    DocumentSession* adopt(OpenedFile opened);
    void remove(DocumentSession* session);
    void applyVectorized(DocumentSession& session, uint64_t revision, Vectorized vectorized);
    void applyRelinked(DocumentSession& session, OpenedFile opened, const QString& path);
    // The gesture is open; it goes with the job, where that goes first, and gives back the state before.
    void startEdit(std::shared_ptr<EditSession> gesture, ElementEdit edit, EditThen then);
    void startSave(DocumentSession& session, const QString& path, bool embedPhoto,
                   std::function<void(bool)> then);
    Job* find(JobKind kind, const DocumentSession* session) const;
    // The document that is in this file, or is being saved there; null for none.
    DocumentSession* sessionAt(const QString& path) const;
    void track(Job* job, const DocumentSession* session, const QString& path = {});
    void stopAll(JobKind kind, const DocumentSession* session);
    // Stops the job at once; its result goes with it.
    void drop(const Job* job);
    // Says the error, unless it is that the user stopped the job.
    void report(const Error& error);

    QList<DocumentSession*> mSessions;
    DocumentSession* mCurrent = nullptr;
    QList<RunningJob> mJobs;
    QHash<DocumentSession*, ClosingPtr> mClosing;
    uint64_t mClosingAll = 0;  // counts the calls of closeAll()
    QHash<const DocumentSession*, ExportRequest> mLastExports;
    QSet<QString> mOpening;
    size_t mHistoryLimit = History::kDefaultMemoryLimit;
};

}  // namespace tessera
