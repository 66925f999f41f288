// See heat_map.h.
#include "app/heat_map.h"

#include <algorithm>
#include <cmath>

#include "app/jobs/render_job.h"
#include "core/base/parallel.h"

namespace tessera {

namespace {

constexpr int kRestMs = 150;
constexpr double kMostOpaque = .85;

}  // namespace

QRgb heatColour(double levels) {
    const double share = std::clamp((levels - kHeatFromLevels) / (kHeatFullLevels - kHeatFromLevels), 0., 1.);
    const double opacity = kMostOpaque * std::sqrt(share);
    return qPremultiply(qRgba(255, int(std::lround(230 * (1 - share))), 30, int(std::lround(255 * opacity))));
}

Result<QImage> heatMap(const PatchMesh& mesh, const Image& photo, Progress& progress) {
    const auto drawn = rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = kPictureSamples}, &progress);
    if (!drawn) return tl::unexpected<Error>(drawn.error());
    QImage map(photo.width(), photo.height(), QImage::Format_ARGB32_Premultiplied);
    const auto width = size_t(photo.width());
    parallelFor(size_t(photo.height()), 16, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) {
            auto* line = reinterpret_cast<QRgb*>(map.scanLine(int(y)));
            for (size_t x = 0; x < width; ++x) {
                double sum = 0;
                for (int c = 0; c < std::min(photo.channels(), 3); ++c) {
                    const double d =
                        double(drawn->plane(c)[y * width + x]) - double(photo.plane(c)[y * width + x]);
                    sum += d * d;
                }
                line[x] = heatColour(255 * std::sqrt(sum));
            }
        }
    });
    return map;
}

HeatMap::HeatMap(QObject* parent) : QObject(parent) {
    mRest.setSingleShot(true);
    mRest.setInterval(kRestMs);
    connect(&mRest, &QTimer::timeout, this, &HeatMap::start);
}

void HeatMap::setSession(DocumentSession* session) {
    if (mSession) mSession->disconnect(this);
    mSession = session;
    if (mSession) connect(mSession, &DocumentSession::changed, this, &HeatMap::follow);
    emit ready({});
    start();
}

void HeatMap::setWanted(bool wanted) {
    mWanted = wanted;
    if (!wanted) emit ready({});
    start();
}

void HeatMap::follow(const Change& change) {
    if (mWanted && (change.mesh() || change.photo)) mRest.start();
}

void HeatMap::start() {
    delete mJob;
    if (!mWanted || !mSession || !mSession->hasMesh()) return;
    // An undo may have taken it away again.
    if (!mSession->photo().image) return emit ready({});
    mJob = new Job(JobKind::Render, tr("Measuring"), this);
    mJob->start<QImage>(
        [mesh = mSession->document().mesh, photo = mSession->photo().image](Progress& progress) {
            progress.beginStage("measuring", 1);
            return heatMap(mesh, *photo, progress);
        },
        [this](Result<QImage> map) {
            if (map) emit ready(*map);
        });
}

}  // namespace tessera
