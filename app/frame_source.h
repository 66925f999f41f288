// Keeps the drawn parts of a vector image up to date with what the canvas shows: the latest wish wins, and
// there is always something to show meanwhile.
#pragma once

#include <QObject>
#include <optional>

#include "app/jobs/render_job.h"
#include "core/mesh/patch_query.h"

namespace tessera {

// Two frames are kept: a small one of the whole picture, so that panning and zooming out never meet a hole,
// and the last one of the wished view. A view is drawn with one sample a pixel first and then with
// kPictureSamples; a new wish interrupts the second drawing but not the first, so that the picture keeps up
// with a hand that does not rest.
class FrameSource : public QObject {
    Q_OBJECT

  public:
    explicit FrameSource(QObject* parent = nullptr) : QObject(parent) {}

    // Forgets the frames and starts on those of `mesh`; one without patches has none.
    void setMesh(PatchMesh mesh);
    // `mesh` looks like the one before but within `dirty` (image px): that part of the frames is drawn anew,
    // the rest stays.
    void updateMesh(PatchMesh mesh, const Rect& dirty);
    // What shall be shown; `view` lies within the picture. Cheap where it is the same as before.
    void request(const View& view);

    const std::optional<Frame>& overview() const { return mOverview; }
    const std::optional<Frame>& latest() const { return mLatest; }
    // Whether latest() is the wished view at its full quality.
    bool settled() const;

  signals:
    void frameReady();

  private:
    void startNext();
    void draw(const View& view, int samples, void (FrameSource::*keep)(Frame));
    void keepOverview(Frame frame) { mOverview = std::move(frame); }
    void keepLatest(Frame frame) { mLatest = std::move(frame); }
    void keepPart(Frame part);

    PatchMesh mMesh;
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
