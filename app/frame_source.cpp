// See frame_source.h.
#include "app/frame_source.h"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "app/mesh_damage.h"

namespace tessera {

namespace {

constexpr double kOverviewPx = 1024;
// How long nothing else is to be drawn before a drawer draws the overview.
constexpr int kRestMs = 100;

Rect united(const Rect& a, const Rect& b) {
    return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

// The pixels of a view that show any of `area`: a view of the same pixels.
View partOf(const View& view, const Rect& area) {
    const glm::dvec2 size(view.width, view.height);
    const glm::dvec2 from =
        glm::clamp(glm::floor((area.min - view.origin) * view.scale), glm::dvec2(0), size);
    const glm::dvec2 to = glm::clamp(glm::ceil((area.max - view.origin) * view.scale), glm::dvec2(0), size);
    return {.origin = view.origin + from / view.scale,
            .scale = view.scale,
            .width = int(to.x - from.x),
            .height = int(to.y - from.y)};
}

}  // namespace

bool sameView(const View& a, const View& b) {
    return a.origin == b.origin && a.scale == b.scale && a.width == b.width && a.height == b.height;
}

FrameSource::FrameSource(QObject* parent) : QObject(parent) {
    mDrawSoon.setSingleShot(true);
    connect(&mDrawSoon, &QTimer::timeout, this, &FrameSource::startNext);
}

void FrameSource::setDrawer(std::unique_ptr<FrameDrawer> drawer) {
    mDrawer = std::move(drawer);
    setMesh(mMesh);
}

void FrameSource::setMesh(PatchMesh mesh) {
    delete mJob;
    mJob = nullptr;
    ++mGeneration;
    mOverview.reset();
    mLatest.reset();
    mDirty.reset();
    mOverviewOld = false;
    mMesh = std::move(mesh);
    if (mDrawer && mMesh.patchCount() > 0) mDrawer->setMesh(mMesh);
    startSoon();
}

void FrameSource::updateMesh(PatchMesh mesh, const Touched& touched) {
    const Rect dirty = damagedArea(mMesh, mesh, touched);
    mMesh = std::move(mesh);
    mDirty = mDirty ? united(*mDirty, dirty) : dirty;
    mOverviewOld = true;
    if (mDrawer && touched.topology)
        mDrawer->setMesh(mMesh);
    else if (mDrawer)
        mDrawer->update(mMesh, touched.patches);
    if (mJob && mRefining) mJob->stop();
    startSoon();
}

void FrameSource::startSoon() {
    mDrawer ? mDrawSoon.start(0) : startNext();
}

void FrameSource::request(const View& view) {
    if (mWish && sameView(*mWish, view)) return;
    mWish = view;
    if (mJob && mRefining) mJob->stop();
    startSoon();
}

bool FrameSource::settled() const {
    return mMesh.patchCount() == 0 || (mWish && mLatest && !wantsView() && !mOverviewOld);
}

void FrameSource::startNext() {
    if (mJob || mMesh.patchCount() == 0 || (mDrawer && drawAtOnce())) return;
    mRefining = false;
    if (!mOverview) return draw(overviewView(), 1, &FrameSource::keepOverview);
    if (!mWish || mWish->width <= 0 || mWish->height <= 0 || settled()) return;
    if (!mLatest || !sameView(mLatest->view, *mWish)) {
        mDirty.reset();
        return draw(*mWish, 1, &FrameSource::keepLatest);
    }
    if (mDirty) {
        const View part = partOf(*mWish, *mDirty);
        mDirty.reset();
        if (part.width > 0 && part.height > 0) return draw(part, 1, &FrameSource::keepPart);
    }
    if (mOverviewOld && mLatest->samples == kPictureSamples) {
        mOverviewOld = false;
        return draw(overviewView(), 1, &FrameSource::keepOverview);
    }
    mRefining = true;
    draw(*mWish, kPictureSamples, &FrameSource::keepLatest);
}

View FrameSource::overviewView() const {
    const double scale = std::min(1.0, kOverviewPx / std::max(mMesh.width(), mMesh.height()));
    return wholePicture(mMesh, {scale, scale});
}

bool FrameSource::wantsView() const {
    return mWish && mWish->width > 0 && mWish->height > 0 &&
           (!mLatest || !sameView(mLatest->view, *mWish) || mLatest->samples != kPictureSamples || mDirty);
}

bool FrameSource::drawAtOnce() {
    const bool view = wantsView();
    if (!view && mOverview && !mOverviewOld) return true;
    const View drawn = view ? *mWish : overviewView();
    Result<QImage> image = mDrawer->draw(drawn);
    if (!image) {
        mDrawer.reset();
        emit drawerLost(QString::fromStdString(image.error().message));
        return false;
    }
    Frame frame{std::move(*image), drawn, kPictureSamples};
    if (view) {
        mDirty.reset();
        keepLatest(std::move(frame));
    } else {
        mOverviewOld = false;
        keepOverview(std::move(frame));
    }
    // It is seen where a view has not been drawn yet, and small: a hand that moves something does not wait
    // for it.
    if (!mOverview || mOverviewOld) mDrawSoon.start(kRestMs);
    emit frameReady();
    return true;
}

void FrameSource::draw(const View& view, int samples, void (FrameSource::*keep)(Frame)) {
    const uint64_t generation = mGeneration;
    mJob = startRenderJob(this, mMesh, view, samples, [=, this](Result<Frame> frame) {
        if (generation != mGeneration) return;
        mJob = nullptr;
        if (frame) {
            (this->*keep)(std::move(*frame));
            emit frameReady();
        } else if (frame.error().code != ErrorCode::Stopped) {
            // Out of memory, in practice. The same wish would fail again: wait for another one.
            mWish.reset();
            return;
        }
        startNext();
    });
}

void FrameSource::keepOverview(Frame frame) {
    mOverview = std::move(frame);
    emit overviewReady();
}

void FrameSource::keepPart(Frame part) {
    const glm::dvec2 offset = (part.view.origin - mLatest->view.origin) * part.view.scale;
    QPainter painter(&mLatest->image);
    painter.setCompositionMode(QPainter::CompositionMode_Source);
    painter.drawImage(QPoint(int(std::lround(offset.x)), int(std::lround(offset.y))), part.image);
    mLatest->samples = part.samples;
}

}  // namespace tessera
