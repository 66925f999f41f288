// See rasterize.h: the fast path.
#include "core/export/rasterize.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/vector_clones.h"
#include "core/mesh/edge_blur.h"
#include "core/mesh/patch_inverse.h"
#include "core/mesh/prefetch.h"
#include "core/mesh/scan_conversion.h"

namespace tessera {

namespace {

constexpr int kTileWidth = 256;
constexpr int kTileHeight = 64;

bool leftOut(const PatchAttributes& a, const RasterizeOptions& options) {
    return a.cutOut || (a.hidden && !options.showHidden);
}

// Pixels of one patch with their parameters, as the runs that they came in.
struct Batch {
    static constexpr size_t kSize = PatchInverse::kMaxBatch;
    static_assert(kSize <= kMaxBlurPoints);

    PatchId patch;
    glm::dvec2 centre{0};  // of the patch
    size_t count = 0;
    std::vector<PixelRun> runs;
    alignas(32) float x[kSize], y[kSize];  // relative to the patch
    alignas(32) float v[kSize], w[kSize];
};

struct Tile {
    PixelRect rect;
    std::vector<uint32_t> patches;  // indices into ScanConversion::patches(), descending
};

// The tiles of a view with the patches that may reach into them. Descending, so that where two patches claim
// a pixel the smaller id writes last.
std::vector<Tile> makeTiles(const ScanConversion& scan, int tileWidth, int tileHeight) {
    const PixelGrid& grid = scan.grid();
    const int columns = (grid.width + tileWidth - 1) / tileWidth,
              rows = (grid.height + tileHeight - 1) / tileHeight;
    std::vector<Tile> tiles(size_t(columns) * size_t(rows));
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            tiles[size_t(j) * size_t(columns) + size_t(i)].rect = {
                i * tileWidth, j * tileHeight, std::min(grid.width, (i + 1) * tileWidth),
                std::min(grid.height, (j + 1) * tileHeight)};
    for (size_t p = scan.patches().size(); p-- > 0;) {
        const PixelRect& box = scan.bounds(p);
        for (int j = box.y0 / tileHeight; j <= (box.y1 - 1) / tileHeight; ++j)
            for (int i = box.x0 / tileWidth; i <= (box.x1 - 1) / tileWidth; ++i)
                tiles[size_t(j) * size_t(columns) + size_t(i)].patches.push_back(uint32_t(p));
    }
    return tiles;
}

// Where the pixel centres of a run lie along x: from `origin`, times `factor`.
TESSERA_VECTOR_CLONES
void centresOf(const PixelGrid& grid, const PixelRun& run, double origin, double factor, float* x) {
    for (int i = run.begin; i < run.end; ++i) x[i - run.begin] = float((grid.centreX(i) - origin) * factor);
}

// Calls emit(batch) with all pixels of the tile, each patch's in batches, patches in descending order.
template <class Emit>
void processTile(const PatchMesh& mesh, const ScanConversion& scan, const Tile& tile, Batch& batch,
                 Emit&& emit) {
    const PixelGrid& grid = scan.grid();
    std::vector<PixelRun> runs;
    // Sides are drawn to a thousandth of an output pixel.
    const double tolerance = .002 / std::max(grid.scale.x, grid.scale.y);
    for (size_t i = 0; i < tile.patches.size(); ++i) {
        const uint32_t index = tile.patches[i];
        if (i + 1 < tile.patches.size()) prefetch(mesh.spline(scan.patches()[tile.patches[i + 1]]));
        batch.patch = scan.patches()[index];
        const PixelRect& box = scan.bounds(index);
        scan.runs(batch.patch,
                  {std::max(tile.rect.x0, box.x0), std::max(tile.rect.y0, box.y0),
                   std::min(tile.rect.x1, box.x1), std::min(tile.rect.y1, box.y1)},
                  runs);
        if (runs.empty()) continue;
        const PatchInverse inverse(mesh.controlPoints(batch.patch), tolerance);
        batch.centre = inverse.centre();
        const auto flush = [&] {
            inverse.solve(batch.x, batch.y, batch.count, batch.v, batch.w);
            emit(batch);
            batch.count = 0;
            batch.runs.clear();
        };
        for (PixelRun run : runs) {
            const auto y = float((grid.centreY(run.row) - inverse.centre().y) * inverse.inverseSize());
            while (run.begin < run.end) {
                const int end = std::min(run.end, run.begin + int(Batch::kSize - batch.count));
                const auto n = size_t(end - run.begin);
                batch.runs.push_back({run.row, run.begin, end});
                centresOf(grid, batch.runs.back(), inverse.centre().x, inverse.inverseSize(),
                          batch.x + batch.count);
                std::fill_n(batch.y + batch.count, n, y);
                batch.count += n;
                run.begin = end;
                if (batch.count == Batch::kSize) flush();
            }
        }
        if (batch.count > 0) flush();
    }
}

// std::copy_n for the few pixels that a run has: no call, the last vector overlapping the one before.
inline void copyRun(const float* from, size_t n, float* to) {
    constexpr size_t kVector = 8;
    if (n >= kVector) {
        for (size_t i = 0; i + kVector <= n; i += kVector)
            std::memcpy(to + i, from + i, kVector * sizeof(float));
        std::memcpy(to + n - kVector, from + n - kVector, kVector * sizeof(float));
    } else if (n >= kVector / 2) {
        std::memcpy(to, from, kVector / 2 * sizeof(float));
        std::memcpy(to + n - kVector / 2, from + n - kVector / 2, kVector / 2 * sizeof(float));
    } else {
        if (n > 0) to[0] = from[0];
        if (n > 1) to[1] = from[1];
        if (n > 2) to[2] = from[2];
    }
}

// Adds what blurred features do to the colours of a batch.
void blurBatch(const PatchMesh& mesh, const EdgeBlur& blur, const PixelGrid& grid, const Batch& batch,
               float* const* colours) {
    alignas(32) float x[Batch::kSize], y[Batch::kSize];
    size_t i = 0;
    for (const PixelRun& run : batch.runs) {
        const auto n = size_t(run.end - run.begin);
        centresOf(grid, run, batch.centre.x, 1, x + i);
        std::fill_n(y + i, n, float(grid.centreY(run.row) - batch.centre.y));
        i += n;
    }
    addBlur(mesh, blur, batch.patch, batch.centre, x, y, batch.count, colours);
}

// Evaluates a batch's colours and writes them into `image`, whose pixel (0, 0) is the view's (x0, y0).
void shade(const PatchMesh& mesh, const EdgeBlur& blur, const PixelGrid& grid, const Batch& batch,
           Image& image, int x0, int y0) {
    alignas(32) float x[Batch::kSize], y[Batch::kSize], colour[kMaxChannels][Batch::kSize];
    for (size_t i = 0; i < batch.count; ++i) {
        x[i] = batch.v[i] + .5f * batch.w[i];
        y[i] = float(kDomainHeight) * batch.w[i];
    }
    float* out[kMaxChannels];
    for (int c = 0; c < kMaxChannels; ++c) out[c] = colour[c];
    evaluateSplines(mesh.spline(batch.patch), mesh.channels(), x, y, batch.count, out);
    if (blur.inReach(batch.patch)) blurBatch(mesh, blur, grid, batch, out);
    toWorking(mesh.colourBasis(), out, batch.count);
    if (image.channels() > mesh.channels())
        std::fill_n(colour[mesh.channels()], batch.count, 1.0F);  // opaque beside what is left out
    for (int c = 0; c < image.channels(); ++c) {
        const float* from = colour[c];
        float* plane = image.plane(c).data();
        for (const PixelRun& run : batch.runs) {
            const auto n = size_t(run.end - run.begin);
            copyRun(from, n, plane + size_t(run.row - y0) * size_t(image.width()) + size_t(run.begin - x0));
            from += n;
        }
    }
}

// Pixels that no patch covers, or one that is left out, stay 0. A tile at a time, for the thread that will
// write it.
void clear(Image& image, const PixelRect& rect) {
    for (int c = 0; c < image.channels(); ++c)
        for (int y = rect.y0; y < rect.y1; ++y)
            std::fill_n(image.plane(c).data() + size_t(y) * size_t(image.width()) + size_t(rect.x0),
                        rect.x1 - rect.x0, 0.0F);
}

// The mean of each n x n block of `fine`, into `image` from (x0, y0) on.
template <int n>
void average(const Image& fine, Image& image, int x0, int y0) {
    constexpr float kShare = 1 / float(n * n);
    const size_t stride = size_t(fine.width());
    for (int c = 0; c < image.channels(); ++c)
        for (int y = 0; y < fine.height() / n; ++y) {
            const float* from = fine.plane(c).data() + size_t(y * n) * stride;
            float* to = &image.at(x0, y0 + y, c);
            for (int x = 0; x < fine.width() / n; ++x) {
                float sum = 0;
                for (int j = 0; j < n; ++j)
                    for (int i = 0; i < n; ++i) sum += from[size_t(j) * stride + size_t(x * n + i)];
                to[x] = kShare * sum;
            }
        }
}

}  // namespace

Result<Image> rasterize(const PatchMesh& mesh, const View& view, const RasterizeOptions& options,
                        Progress* progress) {
    TESSERA_CHECK(options.samples == 1 || options.samples == 4 || options.samples == 16);
    if (progress && progress->stopRequested()) return stopped();
    bool anyLeftOut = false;
    mesh.forEachPatch([&](PatchId p) { anyLeftOut = anyLeftOut || leftOut(mesh.attributes(p), options); });
    const int channels = anyLeftOut ? kMaxChannels : mesh.channels();
    Image image = Image::unset(view.width, view.height, channels);
    // Sub-pixel centres are the pixel centres of the view n times as large.
    const int n = options.samples == 1 ? 1 : options.samples == 4 ? 2 : 4;
    View fine = view;
    fine.scale *= n;
    fine.width *= n;
    fine.height *= n;
    // Neither of the two is parallel throughout, so they are made side by side.
    std::optional<ScanConversion> scanned;
    std::shared_ptr<const EdgeBlur> blurred;
    std::vector<Tile> tiles;
    parallelFor(2, 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            if (i > 0) {
                blurred = edgeBlurOf(mesh, options.sharpen);
                continue;
            }
            scanned.emplace(mesh, fine);
            tiles = makeTiles(*scanned, kTileWidth * n, kTileHeight * n);
        }
    });
    const ScanConversion& scan = *scanned;
    const EdgeBlur& blur = *blurred;
    std::atomic<size_t> done{0};
    std::atomic<bool> stop{false};
    parallelFor(tiles.size(), 1, [&](size_t begin, size_t end) {
        Batch batch;
        for (size_t i = begin; i < end && !stop; ++i) {
            const PixelRect& rect = tiles[i].rect;
            if (n == 1) {
                clear(image, rect);
                processTile(mesh, scan, tiles[i], batch, [&](const Batch& b) {
                    if (!leftOut(mesh.attributes(b.patch), options))
                        shade(mesh, blur, scan.grid(), b, image, 0, 0);
                });
            } else {
                Image part(rect.x1 - rect.x0, rect.y1 - rect.y0, channels);
                processTile(mesh, scan, tiles[i], batch, [&](const Batch& b) {
                    if (!leftOut(mesh.attributes(b.patch), options))
                        shade(mesh, blur, scan.grid(), b, part, rect.x0, rect.y0);
                });
                if (n == 2)
                    average<2>(part, image, rect.x0 / 2, rect.y0 / 2);
                else
                    average<4>(part, image, rect.x0 / 4, rect.y0 / 4);
            }
            const double fraction = double(++done) / double(tiles.size());
            if (progress && !progress->step(fraction)) stop = true;
        }
    });
    if (stop) return stopped();
    return image;
}

std::vector<PixelOwner> locatePixels(const PatchMesh& mesh, const View& view) {
    std::vector<PixelOwner> owners(size_t(view.width) * size_t(view.height));
    const ScanConversion scan(mesh, view);
    const std::vector<Tile> tiles = makeTiles(scan, kTileWidth, kTileHeight);
    parallelFor(tiles.size(), 1, [&](size_t begin, size_t end) {
        Batch batch;
        for (size_t i = begin; i < end; ++i)
            processTile(mesh, scan, tiles[i], batch, [&](const Batch& b) {
                size_t k = 0;
                for (const PixelRun& run : b.runs)
                    for (int x = run.begin; x < run.end; ++x, ++k)
                        owners[size_t(run.row) * size_t(view.width) + size_t(x)] = {b.patch, b.v[k], b.w[k]};
            });
    });
    return owners;
}

}  // namespace tessera
