// See autosave.h.
#include "app/autosave.h"

namespace tessera {

namespace {

struct Written {};

}  // namespace

Autosave::Autosave(Workspace& workspace, RecoveryStore& store, QObject* parent)
    : QObject(parent), mWorkspace(workspace), mStore(store) {
    connect(&mTimer, &QTimer::timeout, this, &Autosave::saveNow);
    connect(&workspace, &Workspace::sessionClosed, this, &Autosave::forget);
    connect(&workspace, &Workspace::saved, this, [this](DocumentSession* session) {
        if (!session->modified()) forget(session);
    });
}

void Autosave::setInterval(int seconds) {
    if (seconds > 0)
        mTimer.start(seconds * 1000);
    else
        mTimer.stop();
}

void Autosave::saveNow() {
    if (!mStore.usable()) return;
    for (DocumentSession* session : mWorkspace.sessions()) {
        if (!session->modified()) forget(session);
        session->whenIdle([this, session] { save(*session); });
    }
}

void Autosave::save(DocumentSession& session) {
    if (!session.modified() || !session.hasMesh()) return;
    Entry& entry = mEntries[&session];
    if (entry.revision == session.revision()) return;
    if (!entry.slot) entry.slot = mStore.newSlot();
    entry.revision = session.revision();
    Document snapshot = session.document();
    if (session.photo().bytes) snapshot.embeddedSource = session.photo().bytes;
    const RecoveryInfo info{session.path(), session.photoPath(), QDateTime::currentDateTimeUtc()};
    auto* job = new Job(JobKind::Autosave, tr("Saving for recovery"), this);
    ++mWriting;
    const auto write = [slot = entry.slot, snapshot = std::move(snapshot),
                        info](Progress&) -> Result<Written> {
        if (auto written = slot->write(snapshot, info); !written)
            return tl::unexpected<Error>(written.error());
        return Written{};
    };
    job->start<Written>(write, [this, slot = entry.slot](Result<Written> written) {
        --mWriting;
        if (!written) {
            // The next round tries again, and does not say it again.
            for (Entry& failed : mEntries)
                if (failed.slot == slot) failed.revision = 0;
            if (!std::exchange(mComplained, true))
                emit mWorkspace.said(
                    {.kind = Message::Kind::Error,
                     .text = tr("Autosave failed: %1").arg(asSentence(written.error().message))});
        }
        if (mWriting == 0) emit idle();
    });
}

void Autosave::recover(std::shared_ptr<RecoverySlot> slot) {
    const auto info = slot->info();
    if (!info) return;
    mWorkspace.openRecovered(
        slot->dataPath(), info->path, info->photoPath,
        [this, slot](DocumentSession& session) { mEntries[&session] = {slot, session.revision()}; });
}

void Autosave::forget(DocumentSession* session) {
    if (const Entry entry = mEntries.take(session); entry.slot) entry.slot->forget();
}

}  // namespace tessera
