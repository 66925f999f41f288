// What sliders have done to the colours of a selection, as long as they can be taken up again.
#pragma once

#include <map>
#include <optional>

#include "app/element_edits.h"
#include "core/edit/recolour.h"

namespace tessera {

// The values that sliders show: of one kind of recolouring at a time (ColourShift, Levels or Tint).
//
// Each gesture recolours the colours from before the first one, so that a slider that goes back to neutral
// brings them back to the bit, and grey colours remember what they were. That lasts until the selection is
// another one, something else is changed, or another kind of recolouring is begun: then all is neutral again.
// Undo and redo bring back what the sliders showed.
class ColourAdjustment {
  public:
    // `set` is what is selected in the session. An EditSession may be open only between begin() and end.
    ColourAdjustment(DocumentSession& session, PatchSet set);

    const PatchSet& patches() const { return mPatches; }
    // What has been done, as far as the session's state is one of this adjustment; nothing for others.
    std::optional<Recolouring> value() const;

    // A gesture: begin, show any number of times, commit or cancel. What is shown is near, what is committed
    // exact. False, and none is begun, where an EditSession is open. `kind` is any value of the recolouring
    // that will be shown.
    bool begin(const QString& text, const Recolouring& kind, const RecolourOptions& options);
    bool active() const { return mGesture && mGesture->open(); }
    void show(const Recolouring& how);
    // `then`, where given, is called when value() is what was committed.
    void commit(const FinishGesture& finish, std::function<void()> then = {});
    void cancel();

  private:
    void committed(const Touched& touched, uint64_t revisionBefore);
    void startFrom(const Recolouring& kind, const RecolourOptions& options);

    QPointer<DocumentSession> mSession;
    PatchSet mPatches;
    PatchMesh mBase;
    double mFeatherPx = 0;
    Touched mTouched;                         // by all steps since the base
    std::map<uint64_t, Recolouring> mValues;  // by revision, the base's too; of one kind
    // Of the gesture under way. A recolourer of many patches is large: it does not outlive its gesture.
    std::shared_ptr<Recolourer> mRecolourer;
    std::shared_ptr<EditSession> mGesture;
    std::optional<Recolouring> mShown;
    std::weak_ptr<EditSession> mEnding;  // committed, but its step has not been made yet
    std::shared_ptr<int> mAlive = std::make_shared<int>();
};

}  // namespace tessera
