// Writes the modified documents of a workspace into the recovery folder from time to time.
#pragma once

#include <QHash>
#include <QObject>
#include <QTimer>

#include "app/recovery_store.h"
#include "app/workspace.h"

namespace tessera {

// A document that is saved, closed or back at its saved state is forgotten by the store. Lives as long as the
// workspace at most; documents that are still open and modified when it ends stay in the store.
class Autosave : public QObject {
    Q_OBJECT

  public:
    Autosave(Workspace& workspace, RecoveryStore& store, QObject* parent = nullptr);

    // 0 turns it off.
    void setInterval(int seconds);
    // Writes what has changed since it was last written, on workers; a document with an open EditSession as
    // soon as that ends.
    void saveNow();
    bool writing() const { return mWriting > 0; }
    // Opens what an earlier run left behind.
    void recover(std::shared_ptr<RecoverySlot> slot);

  signals:
    // A round is over: all has been written.
    void idle();

  private:
    struct Entry {
        std::shared_ptr<RecoverySlot> slot;
        uint64_t revision = 0;  // in the slot, or on its way there
    };

    void save(DocumentSession& session);
    void forget(DocumentSession* session);

    Workspace& mWorkspace;
    RecoveryStore& mStore;
    QTimer mTimer;
    QHash<DocumentSession*, Entry> mEntries;
    int mWriting = 0;
    bool mComplained = false;
};

}  // namespace tessera
