// See selection_picture.h.
#include "app/selection_picture.h"

#include <algorithm>
#include <glm/common.hpp>

#include "app/picture_pyramid.h"
#include "core/base/parallel.h"
#include "core/export/rasterize.h"
#include "core/mesh/patch_query.h"

namespace tessera {

namespace {

constexpr int kSide = 2;  // samples a pixel, along each axis

// The pixels that the patches' boxes meet.
View pixelsOf(const PatchMesh& mesh, const PatchSet& set) {
    Rect box = controlBounds(mesh, set.front());
    for (const PatchId p : set) {
        const Rect bounds = controlBounds(mesh, p);
        box = {glm::min(box.min, bounds.min), glm::max(box.max, bounds.max)};
    }
    const glm::dvec2 lo = glm::max(glm::floor(box.min), glm::dvec2(0));
    const glm::dvec2 hi = glm::min(glm::ceil(box.max), glm::dvec2(mesh.width(), mesh.height()));
    return {.origin = lo, .scale = {1, 1}, .width = int(hi.x - lo.x), .height = int(hi.y - lo.y)};
}

// The mean of the samples that are the set's, the others counted as transparent.
Image averaged(const Image& samples, const std::vector<PixelOwner>& owners,
               const std::vector<uint8_t>& member, const View& view) {
    Image result(view.width, view.height, 4);
    parallelFor(size_t(view.height), 8, [&](size_t begin, size_t end) {
        for (int y = int(begin); y < int(end); ++y)
            for (int i = 0; i < view.width * kSide * kSide; ++i) {
                const int x = i / (kSide * kSide), sample = i % (kSide * kSide);
                const int sx = x * kSide + sample % kSide, sy = y * kSide + sample / kSide;
                const PatchId owner = owners[size_t(sy) * size_t(samples.width()) + size_t(sx)].patch;
                if (!owner.valid() || !member[owner.index]) continue;
                for (int c = 0; c < 4; ++c) {
                    const float value = c < samples.channels() ? samples.at(sx, sy, c) : 1;
                    result.at(x, y, c) += value / (kSide * kSide);
                }
            }
    });
    return result;
}

Result<QImage> draw(const PatchMesh& mesh, const PatchSet& set, Progress& progress) {
    progress.beginStage("drawing", 1);
    if (set.empty())
        return rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = kSide * kSide}, &progress)
            .map(toQImage);
    const View view = pixelsOf(mesh, set);
    View fine = view;
    fine.scale *= kSide;
    fine.width *= kSide;
    fine.height *= kSide;
    return rasterize(mesh, fine, {}, &progress).map([&](const Image& samples) {
        return toQImage(averaged(samples, locatePixels(mesh, fine), membership(mesh, set), view));
    });
}

}  // namespace

Job* startSelectionPictureJob(QObject* owner, PatchMesh mesh, PatchSet set,
                              std::function<void(Result<QImage>)> deliver) {
    auto* job = new Job(JobKind::Copy, QObject::tr("Copying the picture"), owner);
    job->start<QImage>([mesh = std::move(mesh),
                        set = std::move(set)](Progress& progress) { return draw(mesh, set, progress); },
                       std::move(deliver));
    return job;
}

}  // namespace tessera
