// See patch_cells.h.
#include "core/vectorize/patch_cells.h"

#include <algorithm>
#include <numeric>

#include "core/mesh/patch_inverse.h"

namespace tessera {

namespace {

constexpr uint32_t kNone = ~uint32_t{0};

// The parametric domain points of the samples.
void findParameters(const LatticeTriangle& patch, PatchCells& cells) {
    const PatchInverse inverse(patch, .001);
    const size_t count = cells.at.size();
    cells.x.resize(count);
    cells.y.resize(count);
    constexpr size_t kBatch = PatchInverse::kMaxBatch;
    alignas(32) float x[kBatch], y[kBatch], v[kBatch], w[kBatch];
    for (size_t first = 0; first < count; first += kBatch) {
        const size_t n = std::min(kBatch, count - first);
        for (size_t k = 0; k < n; ++k) {
            const glm::dvec2 d = (glm::dvec2(cells.at[first + k]) - inverse.centre()) * inverse.inverseSize();
            x[k] = float(d.x);
            y[k] = float(d.y);
        }
        inverse.solve(x, y, n, v, w);
        for (size_t k = 0; k < n; ++k) {
            cells.x[first + k] = v[k] + .5F * w[k];
            cells.y[first + k] = float(kDomainHeight) * w[k];
        }
    }
}

}  // namespace

CellSampler::CellSampler(const PatchMesh& mesh, const FitGrid& grid, int samplesPerSide)
    : mMesh(mesh),
      mGrid(grid),
      mSide(samplesPerSide),
      mScan(mesh, wholePicture(mesh, glm::dvec2(grid.perSide * samplesPerSide))) {}

// `places` in `cells` by square of `squares`.
void CellSampler::addSamples(const PixelRun& run, const PixelRect& squares, std::vector<uint32_t>& places,
                             std::vector<PatchCells::Cell>& cells, std::vector<Sample>& samples) const {
    const uint32_t columns = uint32_t(mGrid.width * mGrid.perSide);
    for (int k = run.begin; k < run.end; ++k) {
        const uint32_t number = mGrid.cellAt(k / mSide, run.row / mSide);
        const int column = int(number % columns) - squares.x0, row = int(number / columns) - squares.y0;
        uint32_t& place = places[size_t(row) * size_t(squares.x1 - squares.x0) + size_t(column)];
        if (place == kNone) {
            place = uint32_t(cells.size());
            const float area = mGrid.area(number);
            const float perPx = float(mSide * mGrid.perSide) * float(mSide * mGrid.perSide);
            cells.push_back({number, area, 1 / (perPx * area), 0});
        }
        cells[place].coverage += cells[place].share;
        samples.push_back({place, {float(mScan.grid().centreX(k)), float(mScan.grid().centreY(run.row))}});
    }
}

void CellSampler::sample(size_t i, PatchCells& result) const {
    result.cells.clear();
    const PatchId p = mScan.patches()[i];
    const PixelRect& box = mScan.bounds(i);
    std::vector<PixelRun> runs;
    mScan.runs(p, box, runs);
    // Of all pixels that the box touches: a whole pixel's number is that of its first square.
    const int perPx = mSide * mGrid.perSide;
    const PixelRect squares{box.x0 / perPx * mGrid.perSide, box.y0 / perPx * mGrid.perSide,
                            ((box.x1 - 1) / perPx + 1) * mGrid.perSide,
                            ((box.y1 - 1) / perPx + 1) * mGrid.perSide};
    std::vector<uint32_t> places(size_t(squares.x1 - squares.x0) * size_t(squares.y1 - squares.y0), kNone);
    std::vector<Sample> samples;
    for (const PixelRun& run : runs) addSamples(run, squares, places, result.cells, samples);
    result.firstSample.assign(result.cells.size() + 1, 0);
    for (const Sample& s : samples) ++result.firstSample[s.cell + 1];
    std::partial_sum(result.firstSample.begin(), result.firstSample.end(), result.firstSample.begin());
    std::vector<uint32_t> next(result.firstSample.begin(), result.firstSample.end() - 1);
    result.at.resize(samples.size());
    for (const Sample& s : samples) result.at[next[s.cell]++] = s.at;
    findParameters(mMesh.controlPoints(p), result);
}

}  // namespace tessera
