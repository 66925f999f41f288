// See frame_source.h.
#include "app/frame_source.h"

#include <algorithm>

namespace tessera {

namespace {

constexpr double kOverviewPx = 1024;

}  // namespace

bool sameView(const View& a, const View& b) {
    return a.origin == b.origin && a.scale == b.scale && a.width == b.width && a.height == b.height;
}

void FrameSource::setMesh(PatchMesh mesh) {
    delete mJob;
    mJob = nullptr;
    ++mGeneration;
    mOverview.reset();
    mLatest.reset();
    mMesh = std::move(mesh);
    startNext();
}

void FrameSource::request(const View& view) {
    if (mWish && sameView(*mWish, view)) return;
    mWish = view;
    if (mJob && mRefining) mJob->stop();
    startNext();
}

bool FrameSource::settled() const {
    return mMesh.patchCount() == 0 ||
           (mLatest && mWish && sameView(mLatest->view, *mWish) && mLatest->samples == kPictureSamples);
}

void FrameSource::startNext() {
    if (mJob || mMesh.patchCount() == 0) return;
    const uint64_t generation = mGeneration;
    if (!mOverview) {
        const double scale = std::min(1.0, kOverviewPx / std::max(mMesh.width(), mMesh.height()));
        mRefining = false;
        mJob =
            startRenderJob(this, mMesh, wholePicture(mMesh, {scale, scale}), 1,
                           [=, this](Result<Frame> frame) { deliver(true, generation, std::move(frame)); });
        return;
    }
    if (!mWish || mWish->width <= 0 || mWish->height <= 0 || settled()) return;
    mRefining = mLatest && sameView(mLatest->view, *mWish);
    mJob = startRenderJob(this, mMesh, *mWish, mRefining ? kPictureSamples : 1,
                          [=, this](Result<Frame> frame) { deliver(false, generation, std::move(frame)); });
}

void FrameSource::deliver(bool overview, uint64_t generation, Result<Frame> frame) {
    if (generation != mGeneration) return;
    mJob = nullptr;
    if (frame) {
        (overview ? mOverview : mLatest) = std::move(*frame);
        emit frameReady();
    } else if (frame.error().code != ErrorCode::Stopped) {
        // Out of memory, in practice. The same wish would fail again: wait for another one.
        mWish.reset();
        return;
    }
    startNext();
}

}  // namespace tessera
