// See draft_preview.h.
#include "app/draft_preview.h"

#include <algorithm>
#include <utility>

#include "app/jobs/draft_job.h"

namespace tessera {

DraftPreview::DraftPreview(Workspace& workspace, QObject* parent) : QObject(parent), mWorkspace(workspace) {}

void DraftPreview::setSession(DocumentSession* session) {
    drop();
    mSession = session;
}

DraftPreview::Drafts& DraftPreview::draftsOf(DocumentSession& session) {
    const auto [found, isNew] = mDrafts.try_emplace(&session);
    if (isNew) {
        connect(&session, &QObject::destroyed, this, [this](QObject* gone) { mDrafts.erase(gone); });
        connect(&session, &DocumentSession::changed, this, [this, &session](const Change& change) {
            if (change.photo) draftsOf(session).ladder.reset();
            if (&session == mSession && (change.mesh() || change.photo)) drop();
        });
    }
    return found->second;
}

void DraftPreview::want(const VectorizeSettings& settings) {
    if (!mSession || !mSession->photo().image || settings.method != "default") return;
    mWish = settings;
    mWishDrawn = false;
    Drafts& drafts = draftsOf(*mSession);
    if (!serves(drafts)) build(drafts);
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

bool DraftPreview::serves(const Drafts& drafts) const {
    // A small picture's ladder may end below what it was built for: a new one would not be longer.
    return drafts.ladder && drafts.settings.featureBudget == mWish->featureBudget &&
           std::max(drafts.ladder->mostPatches(), size_t(drafts.settings.patches)) >= size_t(mWish->patches);
}

void DraftPreview::build(Drafts& drafts) {
    if (std::exchange(drafts.building, true)) return;
    const QPointer<DocumentSession> session = mSession;
    const VectorizeSettings settings = *mWish;
    const auto photo = mSession->photo().image;
    mWorkspace.buildDrafts(settings, [this, session, settings, photo](auto ladder) {
        if (!session) return;
        Drafts& built = draftsOf(*session);
        built.building = false;
        const bool shown = session == mSession;
        if (!ladder && shown) return forgetWish();
        if (session->photo().image == photo) {
            built.ladder = std::move(ladder);
            built.settings = settings;
        }
        // The slider may have gone on meanwhile.
        if (shown && mWish) want(VectorizeSettings(*mWish));
    });
}

void DraftPreview::drawNext() {
    if (mRung || !mWish || mWishDrawn) return;
    const Drafts& drafts = draftsOf(*mSession);
    if (!drafts.ladder) return;
    mWishDrawn = true;
    mRung = startRungJob(this, drafts.ladder, size_t(mWish->patches), [this](Result<PatchMesh> mesh) {
        mRung.clear();
        if (!mesh) return forgetWish();
        mMesh = std::move(*mesh);
        emit changed();
        drawNext();
    });
}

}  // namespace tessera
