// Keeps the drawn parts of a vector image up to date with what the canvas shows: the latest wish wins, and
// there is always something to show meanwhile.
#pragma once

#include <QObject>
#include <QTimer>
#include <memory>
#include <optional>

#include "app/frame_drawer.h"
#include "app/jobs/render_job.h"
#include "core/edit/touched.h"
#include "core/mesh/patch_query.h"

namespace tessera {

// Two frames are kept: a small one of the whole picture, so that panning and zooming out never meet a hole,
// and the last one of the wished view. On a worker a view is drawn with one sample a pixel first and then
// with kPictureSamples; a new wish interrupts the second drawing but not the first, so that the picture keeps
// up with a hand that does not rest. A drawer draws views at full quality, and the small one when there is a
// rest.
class FrameSource : public QObject {
    Q_OBJECT

  public:
    explicit FrameSource(QObject* parent = nullptr);

    // Forgets the frames and starts on those of `mesh`; one without patches has none.
    void setMesh(PatchMesh mesh);
    // `mesh` differs from the one before by `touched`: where that can be seen the frames are drawn anew, the
    // rest stays.
    void updateMesh(PatchMesh mesh, const Touched& touched);
    // Draws the wished views from now on, in place of workers; null goes back to them.
    void setDrawer(std::unique_ptr<FrameDrawer> drawer);
    bool hasDrawer() const { return mDrawer != nullptr; }
    // What shall be shown; `view` lies within the picture. Cheap where it is the same as before.
    void request(const View& view);

    const std::optional<Frame>& overview() const { return mOverview; }
    const std::optional<Frame>& latest() const { return mLatest; }
    // Whether latest() is the wished view at its full quality.
    bool settled() const;

  signals:
    // Either frame is another one; after overviewReady() where it is that one.
    void frameReady();
    void overviewReady();
    // The drawer has failed and is gone; workers go on.
    void drawerLost(const QString& reason);

  private:
    void startNext();
    void startSoon();
    View overviewView() const;
    // Whether latest() is not the wished view at full quality.
    bool wantsView() const;
    // Whether the drawer has drawn what was to be drawn next.
    bool drawAtOnce();
    void draw(const View& view, int samples, void (FrameSource::*keep)(Frame));
    void keepOverview(Frame frame);
    void keepLatest(Frame frame) { mLatest = std::move(frame); }
    void keepPart(Frame part);

    PatchMesh mMesh;
    std::unique_ptr<FrameDrawer> mDrawer;
    QTimer mDrawSoon;          // so that what happens between two frames is drawn once
    uint64_t mGeneration = 0;  // of mMesh, so that a frame of an older one is dropped
    std::optional<View> mWish;
    std::optional<Frame> mOverview;
    std::optional<Frame> mLatest;
    Job* mJob = nullptr;
    bool mRefining = false;  // mJob draws at full quality
    // What mLatest shows of an older mesh, and mJob does not draw; image px.
    std::optional<Rect> mDirty;
    bool mOverviewOld = false;
};

// Whether two views show the same pixels of the same picture.
bool sameView(const View& a, const View& b);

}  // namespace tessera
