// See patch_pixels.h.
#include "core/vectorize/patch_pixels.h"

#include <algorithm>

#include "core/mesh/patch_inverse.h"

namespace tessera {

namespace {

View fineView(const PatchMesh& mesh, int samplesPerSide) {
    return wholePicture(mesh, glm::dvec2(samplesPerSide));
}

}  // namespace

PixelSampler::PixelSampler(const PatchMesh& mesh, int samplesPerSide)
    : mMesh(mesh), mSide(samplesPerSide), mScan(mesh, fineView(mesh, samplesPerSide)) {}

void PixelSampler::sample(size_t i, PatchPixels& result) const {
    constexpr uint32_t kNone = ~uint32_t{0};
    result.pixels.clear();
    result.pixelOf.clear();
    result.at.clear();
    const PatchId p = mScan.patches()[i];
    const PixelRect& box = mScan.bounds(i);
    std::vector<PixelRun> runs;
    mScan.runs(p, box, runs);
    const int x0 = box.x0 / mSide, y0 = box.y0 / mSide;
    const int columns = (box.x1 - 1) / mSide - x0 + 1, rows = (box.y1 - 1) / mSide - y0 + 1;
    std::vector<uint32_t> places(size_t(columns) * size_t(rows), kNone);
    const float share = 1 / float(mSide * mSide);
    const PixelGrid& grid = mScan.grid();
    for (const PixelRun& run : runs)
        for (int k = run.begin; k < run.end; ++k) {
            const int px = k / mSide, py = run.row / mSide;
            uint32_t& place = places[size_t(py - y0) * size_t(columns) + size_t(px - x0)];
            if (place == kNone) {
                place = uint32_t(result.pixels.size());
                result.pixels.push_back({uint32_t(py) * uint32_t(mMesh.width()) + uint32_t(px), 0});
            }
            result.pixels[place].coverage += share;
            result.pixelOf.push_back(place);
            result.at.push_back({float(grid.centreX(k)), float(grid.centreY(run.row))});
        }

    const PatchInverse inverse(mMesh.controlPoints(p), .001);
    const size_t count = result.at.size();
    result.x.resize(count);
    result.y.resize(count);
    constexpr size_t kBatch = PatchInverse::kMaxBatch;
    alignas(32) float x[kBatch], y[kBatch], v[kBatch], w[kBatch];
    for (size_t first = 0; first < count; first += kBatch) {
        const size_t n = std::min(kBatch, count - first);
        for (size_t k = 0; k < n; ++k) {
            const glm::dvec2 d =
                (glm::dvec2(result.at[first + k]) - inverse.centre()) * inverse.inverseSize();
            x[k] = float(d.x);
            y[k] = float(d.y);
        }
        inverse.solve(x, y, n, v, w);
        for (size_t k = 0; k < n; ++k) {
            result.x[first + k] = v[k] + .5F * w[k];
            result.y[first + k] = float(kDomainHeight) * w[k];
        }
    }
}

}  // namespace tessera
