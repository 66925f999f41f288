// A recolouring of the selection under a panel's sliders: shown as they move, one step at the end.
#pragma once

#include <optional>

#include "app/edit_session.h"
#include "core/edit/recolour.h"

namespace tessera {

// From the press of a slider (or the opening of a colour popup) to its release. Its end without commit()
// gives back the colours from before.
class RecolourGesture {
  public:
    // No EditSession is open; the selection has patches.
    RecolourGesture(DocumentSession& session, const QString& text, const RecolourOptions& options = {})
        : mEdit(session, text), mRecolourer(mEdit.start(), session.selection().patches(), options) {}

    // Of the colours from before, not of those shown last. Shown nearly, in the time of a frame; commit()
    // then makes it exact.
    void show(const Recolouring& how) {
        mLast = how;
        // Recolourings have no way to fail.
        (void)mEdit.preview([&](PatchMesh& mesh) { return mRecolourer.preview(mesh, how); });
    }
    void commit() {
        if (mLast) (void)mEdit.preview([&](PatchMesh& mesh) { return mRecolourer.apply(mesh, *mLast); });
        mEdit.commit();
    }

  private:
    EditSession mEdit;
    Recolourer mRecolourer;
    std::optional<Recolouring> mLast;
};

}  // namespace tessera
