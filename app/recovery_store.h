// Where unsaved documents survive a crash: a folder for each running instance, found by the next one.
//
//     ROOT/INSTANCE/lock            held (QLockFile) for as long as the instance runs
//     ROOT/INSTANCE/ID.json         the manifest: what the document is, and which data file is the good one
//     ROOT/INSTANCE/ID-a.tessera    its data; in turns with ID-b.tessera
//
// Data are written whole beside those before, then the manifest is replaced, then the old data go. To forget
// a document, its manifest goes first. So whenever the power fails, what a manifest names is whole.
#pragma once

#include <QDateTime>
#include <QLockFile>
#include <QString>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/result.h"
#include "core/document/document.h"

namespace tessera {

// What a person needs to know of an autosaved document.
struct RecoveryInfo {
    QString path;       // of its file; empty where it was never saved
    QString photoPath;  // where its photo came from
    QDateTime time;     // of the autosave, UTC

    bool operator==(const RecoveryInfo&) const = default;
};

// The place of one document. Thread-safe: a worker writes while the UI thread may forget.
class RecoverySlot {
  public:
    RecoverySlot(QString folder, QString id) : mFolder(std::move(folder)), mId(std::move(id)) {}

    // Puts a snapshot in the place of the one before. Of no effect after forget().
    Result<void> write(Document snapshot, const RecoveryInfo& info);
    // Removes what is there, for good. Does not wait for a write under way, which then removes what it wrote.
    void forget();

    const QString& id() const { return mId; }
    // The manifest's; none where there is no manifest or its data file is gone.
    std::optional<RecoveryInfo> info() const;
    QString dataPath() const;

  private:
    QString manifestPath() const;
    QString dataPath(const QString& name) const;
    // The name of the data file that the manifest points to; empty for none.
    QString currentData() const;

    Result<void> replace(const std::vector<uint8_t>& bytes, const RecoveryInfo& info);

    QString mFolder;
    QString mId;
    std::mutex mMutex;  // of the files
    std::atomic<bool> mForgotten = false;
};

class RecoveryStore {
  public:
    // Under `root`, which is made where it is missing. Without a lock there (a read-only disk, say) the store
    // is not usable, and does nothing.
    explicit RecoveryStore(const QString& root = defaultRoot());
    // Leaves what has not been forgotten for the next run.
    ~RecoveryStore();

    static QString defaultRoot();

    bool usable() const { return mLocks.size() > 0; }
    std::shared_ptr<RecoverySlot> newSlot();
    // What instances that run no more left behind, newest first. From now on it is this instance's: to be
    // recovered or forgotten, or left to the next.
    std::vector<std::shared_ptr<RecoverySlot>> leftBehind();

  private:
    // Makes the folder's lock ours; false where somebody else holds it.
    bool lock(const QString& folder);

    QString mRoot;
    QString mFolder;
    std::vector<std::pair<QString, std::unique_ptr<QLockFile>>> mLocks;  // by folder, the own one first
};

}  // namespace tessera
