// See history.h.
#include "app/history.h"

#include <algorithm>
#include <numeric>

#include "app/document_session.h"
#include "core/base/check.h"

namespace tessera {

void History::push(EditCommand command) {
    TESSERA_CHECK(!mSession.editing());
    while (count() > mIndex) mSteps.pop_back();
    mSteps.push_back(std::move(command));
    ++mIndex;
    mSteps.back().swap();
    forgetOldest();
    emit changed();
}

void History::joinLast() {
    TESSERA_CHECK(!mSession.editing());
    if (mIndex < 2 || canRedo() || revision(mIndex - 1) == mSession.savedRevision()) return;
    mSteps[size_t(mIndex - 2)].join(mSteps.back());
    mSteps.pop_back();
    --mIndex;
    emit changed();
}

void History::undo() {
    mSession.whenIdle([this] { moveTo(mIndex - 1); });
}

void History::redo() {
    mSession.whenIdle([this] { moveTo(mIndex + 1); });
}

void History::goTo(int state) {
    mSession.whenIdle([this, state] { moveTo(state); });
}

void History::moveTo(int state) {
    if (state == mIndex || state < 0 || state > count()) return;
    while (mIndex > state) mSteps[size_t(--mIndex)].swap();
    while (mIndex < state) mSteps[size_t(mIndex++)].swap();
    emit changed();
}

uint64_t History::revision(int state) const {
    if (state == mIndex) return mSession.revision();
    return mSteps[size_t(state < mIndex ? state : state - 1)].otherRevision();
}

int History::savedIndex() const {
    if (mSession.path().isEmpty()) return -1;  // a photo that was opened is no file of ours
    for (int state = 0; state <= count(); ++state)
        if (revision(state) == mSession.savedRevision()) return state;
    return -1;
}

size_t History::bytes() const {
    return std::accumulate(mSteps.begin(), mSteps.end(), size_t{0},
                           [](size_t sum, const EditCommand& step) { return sum + step.bytes(); });
}

void History::setMemoryLimit(size_t bytes) {
    mMemoryLimit = bytes;
    forgetOldest();
    emit changed();
}

// A step that has been undone comes after the document's state, so it does not hang on an older one: with
// nothing left to undo, the latest of the undone steps go.
void History::forgetOldest() {
    size_t held = bytes();
    while (held > mMemoryLimit && count() > 1) {
        const bool oldest = mIndex > 0;
        held -= (oldest ? mSteps.front() : mSteps.back()).bytes();
        if (oldest) {
            mSteps.pop_front();
            --mIndex;
            mForgot = true;
        } else {
            mSteps.pop_back();
        }
    }
}

}  // namespace tessera
