// See draft_preview.h.
#include "app/draft_preview.h"

#include <algorithm>
#include <utility>

#include "app/jobs/draft_job.h"

namespace tessera {

DraftPreview::DraftPreview(Workspace& workspace, QObject* parent) : QObject(parent), mWorkspace(workspace) {}

void DraftPreview::setSession(DocumentSession* session) {
    drop();
    if (mSession) mSession->disconnect(this);
    mSession = session;
    mLadder.reset();
    mBuilding = false;
    if (!session) return;
    connect(session, &DocumentSession::changed, this, [this](const Change& change) {
        if (change.photo) mLadder.reset();
        if (change.mesh() || change.photo) drop();
    });
}

void DraftPreview::want(const VectorizeSettings& settings) {
    if (!mSession || !mSession->photo().image || settings.method != "default") return;
    mWish = settings;
    mWishDrawn = false;
    if (!ladderServes()) build();
    drawNext();
}

void DraftPreview::drop() {
    forgetWish();
    if (std::exchange(mMesh, std::nullopt)) emit changed();
}

void DraftPreview::forgetWish() {
    mWish.reset();
    delete mRung;
}

bool DraftPreview::ladderServes() const {
    // A small picture's ladder may end below what it was built for: a new one would not be longer.
    return mLadder && mLadderSettings.featureBudget == mWish->featureBudget &&
           std::max(mLadder->mostPatches(), size_t(mLadderSettings.patches)) >= size_t(mWish->patches);
}

void DraftPreview::build() {
    if (mBuilding) return;
    mBuilding = true;
    const QPointer<DocumentSession> session = mSession;
    const VectorizeSettings settings = *mWish;
    mWorkspace.buildDrafts(settings, [this, session, settings](std::shared_ptr<const DraftLadder> ladder) {
        if (!session || session != mSession) return;
        mBuilding = false;
        if (!ladder) return forgetWish();
        mLadder = std::move(ladder);
        mLadderSettings = settings;
        // The slider may have gone on meanwhile.
        if (mWish) want(VectorizeSettings(*mWish));
    });
}

void DraftPreview::drawNext() {
    if (mRung || !mWish || !mLadder || mWishDrawn) return;
    mWishDrawn = true;
    mRung = startRungJob(this, mLadder, size_t(mWish->patches), [this](Result<PatchMesh> mesh) {
        mRung.clear();
        if (!mesh) return forgetWish();
        mMesh = std::move(*mesh);
        emit changed();
        drawNext();
    });
}

}  // namespace tessera
