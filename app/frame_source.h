// Keeps the drawn parts of a vector image up to date with what the canvas shows: the latest wish wins, and
// there is always something to show meanwhile.
#pragma once

#include <QObject>
#include <optional>

#include "app/jobs/render_job.h"
#include "core/mesh/patch_mesh.h"

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
    void deliver(bool overview, uint64_t generation, Result<Frame> frame);

    PatchMesh mMesh;
    uint64_t mGeneration = 0;  // of mMesh, so that a frame of an older one is dropped
    std::optional<View> mWish;
    std::optional<Frame> mOverview;
    std::optional<Frame> mLatest;
    Job* mJob = nullptr;
    bool mRefining = false;  // mJob draws at full quality
};

// Whether two views show the same pixels of the same picture.
bool sameView(const View& a, const View& b);

}  // namespace tessera
