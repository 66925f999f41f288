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
    if (mShown && (active() || !mEnding.expired())) return mShown;
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
    mGesture = std::make_shared<EditSession>(*mSession, text);
    mRecolourer = std::make_shared<Recolourer>(mBase, mPatches, options);
    return true;
}

void ColourAdjustment::show(const Recolouring& how) {
    if (!active()) return;
    mShown = how;
    // Recolourings have no way to fail.
    (void)mGesture->preview([&](PatchMesh& mesh) -> Result<Touched> {
        mesh = mBase;
        return united(mTouched, mRecolourer->preview(mesh, how));
    });
}

void ColourAdjustment::commit(const FinishGesture& finish, std::function<void()> then) {
    if (!active() || !mShown) return cancel();
    ElementEdit edit =
        exactRecolouring(mGesture->text(), std::exchange(mRecolourer, nullptr), *mShown, mPatches.size());
    edit.run = [run = std::move(edit.run), base = mBase, before = mTouched](PatchMesh& mesh,
                                                                            Progress& progress) {
        mesh = base;
        return run(mesh, progress).map([&](const EditedElements& edited) {
            return EditedElements{united(before, edited.touched), edited.remark};
        });
    };
    mEnding = mGesture;
    const std::weak_ptr<int> alive = mAlive;
    finish(std::exchange(mGesture, nullptr), std::move(edit),
           [this, alive, then = std::move(then), before = mSession->revision()](const Touched& touched) {
               if (alive.expired()) return;
               committed(touched, before);
               if (then) then();
           });
}

void ColourAdjustment::committed(const Touched& touched, uint64_t revisionBefore) {
    const std::optional<Recolouring> shown = mShown;
    cancel();
    // Where the gesture ended as it began there is no step.
    if (!shown || !mSession || mSession->revision() == revisionBefore) return;
    mTouched = touched;
    mValues.insert_or_assign(mSession->revision(), *shown);
}

void ColourAdjustment::cancel() {
    mGesture.reset();
    mRecolourer.reset();
    mShown.reset();
}

}  // namespace tessera
