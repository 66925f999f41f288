// A recolouring under a panel's sliders: shown as they move, one step at the end.
#pragma once

#include <optional>

#include "app/element_edits.h"
#include "core/edit/recolour.h"

namespace tessera {

// From the press of a slider (or the opening of a colour popup) to its release. Its end without commit()
// gives back the colours from before.
class RecolourGesture {
  public:
    // No EditSession is open; the selection has patches.
    RecolourGesture(DocumentSession& session, const QString& text, const RecolourOptions& options = {})
        : RecolourGesture(session, text, session.selection().patches(), options) {}
    // Of these patches instead of those selected.
    RecolourGesture(DocumentSession& session, const QString& text, PatchSet patches,
                    const RecolourOptions& options = {})
        : mPatches(patches.size()),
          mEdit(std::make_shared<EditSession>(session, text)),
          mRecolourer(std::make_shared<Recolourer>(mEdit->start(), std::move(patches), options)) {}

    // Of the colours from before, not of those shown last. Shown nearly, in the time of a frame; commit()
    // then makes it exact.
    void show(const Recolouring& how) {
        mLast = how;
        // Recolourings have no way to fail.
        (void)mEdit->preview([&](PatchMesh& mesh) { return mRecolourer->preview(mesh, how); });
    }
    // The last thing that is done with the gesture.
    void commit(const FinishGesture& finish) {
        if (mLast) finish(mEdit, exactRecolouring(mEdit->text(), mRecolourer, *mLast, mPatches), {});
        mEdit.reset();
    }

  private:
    size_t mPatches;
    std::shared_ptr<EditSession> mEdit;
    std::shared_ptr<Recolourer> mRecolourer;
    std::optional<Recolouring> mLast;
};

}  // namespace tessera
