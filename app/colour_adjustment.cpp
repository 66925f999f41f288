// See colour_adjustment.h.
#include "app/colour_adjustment.h"

#include <utility>

namespace tessera {

namespace {

// What changes nothing, of the same kind.
Recolouring neutral(const Recolouring& kind) {
    return std::visit([](const auto& how) -> Recolouring { return std::decay_t<decltype(how)>{}; }, kind);
}

}  // namespace

ColourAdjustment::ColourAdjustment(DocumentSession& session, PatchSet set)
    : mSession(&session), mPatches(std::move(set)), mBase(session.document().mesh) {}

std::optional<Recolouring> ColourAdjustment::value() const {
    if (active() && mShown) return mShown;
    if (!mSession) return {};
    const auto found = mValues.find(mSession->revision());
    return found == mValues.end() ? std::nullopt : std::optional(found->second);
}

void ColourAdjustment::startFrom(const Recolouring& kind, const RecolourOptions& options) {
    mBase = mSession->document().mesh;
    mFeatherPx = options.featherPx;
    mTouched = {};
    mValues = {{mSession->revision(), neutral(kind)}};
}

bool ColourAdjustment::begin(const QString& text, const Recolouring& kind, const RecolourOptions& options) {
    if (!mSession || mSession->editing() || mPatches.empty()) return false;
    const auto now = value();
    if (!now || now->index() != kind.index() || mFeatherPx != options.featherPx) startFrom(kind, options);
    mGesture.emplace(*mSession, text);
    mRecolourer.emplace(mBase, mPatches, options);
    return true;
}

void ColourAdjustment::show(const Recolouring& how) {
    if (!active()) return;
    mShown = how;
    draw(&Recolourer::preview);
}

void ColourAdjustment::draw(Touched (Recolourer::*recolour)(PatchMesh&, const Recolouring&) const) {
    // Recolourings have no way to fail.
    (void)mGesture->preview([&](PatchMesh& mesh) -> Result<Touched> {
        mesh = mBase;
        return united(mTouched, ((*mRecolourer).*recolour)(mesh, *mShown));
    });
}

void ColourAdjustment::commit() {
    if (!active() || !mShown) return cancel();
    draw(&Recolourer::apply);
    const Touched touched = mGesture->touched();
    // Where the gesture ended as it began there is no step.
    const uint64_t before = mSession->revision();
    const Recolouring shown = *mShown;
    mGesture->commit();
    cancel();
    if (!mSession || mSession->revision() == before) return;
    mTouched = touched;
    mValues.insert_or_assign(mSession->revision(), shown);
}

void ColourAdjustment::cancel() {
    mGesture.reset();
    mRecolourer.reset();
    mShown.reset();
}

}  // namespace tessera
