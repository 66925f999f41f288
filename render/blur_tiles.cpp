// See blur_tiles.h.
#include "render/blur_tiles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::render {

namespace {

constexpr double kSlack = .05;  // image pixels: more than the rounding of single precision

// The view's tiles, 1 where a feature reaches. In larger views they are larger, so that there are not more of
// them than a driver sets up in a small part of a frame.
class TileGrid {
  public:
    explicit TileGrid(const View& view) : mView(view) {
        constexpr int kSmallest = 8;
        constexpr double kMost = 8000;
        mSize = kSmallest;
        while (double(view.width) * view.height / (double(mSize) * mSize) > kMost) mSize *= 2;
        mColumns = (view.width + mSize - 1) / mSize;
        mRows = (view.height + mSize - 1) / mSize;
        mReached.assign(size_t(mColumns) * size_t(mRows), 0);
        mHalfDiagonal = .5 * mSize * glm::length(1.0 / view.scale);
    }

    void add(const EdgeBlur::Segment& segment, double reach) {
        const glm::dvec2 to = segment.from + segment.along;
        const glm::dvec2 lo = glm::min(segment.from, to) - reach, hi = glm::max(segment.from, to) + reach;
        const glm::dvec2 perTile = mView.scale / double(mSize);
        const auto index = [](double at, int count) {
            return int(std::clamp(std::floor(at), 0.0, double(count)));
        };
        const glm::dvec2 first = (lo - mView.origin) * perTile, last = (hi - mView.origin) * perTile;
        const double away = reach + mHalfDiagonal;
        for (int j = index(first.y, mRows); j < index(last.y + 1, mRows); ++j)
            for (int i = index(first.x, mColumns); i < index(last.x + 1, mColumns); ++i) {
                const glm::dvec2 middle = mView.origin + (glm::dvec2(i, j) + .5) / perTile;
                if (segment.nearest(middle).second <= away * away) mReached[at(i, j)] = 1;
            }
    }

    // Runs of tiles of one kind, row by row.
    void appendRuns(bool reached, std::vector<glm::ivec4>& rects) const {
        for (int j = 0; j < mRows; ++j)
            for (int i = 0; i < mColumns; ++i) {
                if (bool(mReached[at(i, j)]) != reached) continue;
                const int begin = i;
                while (i + 1 < mColumns && bool(mReached[at(i + 1, j)]) == reached) ++i;
                rects.emplace_back(begin * mSize, j * mSize, std::min(mView.width, (i + 1) * mSize),
                                   std::min(mView.height, (j + 1) * mSize));
            }
    }

  private:
    size_t at(int i, int j) const { return size_t(j) * size_t(mColumns) + size_t(i); }

    View mView;
    int mSize, mColumns, mRows;
    double mHalfDiagonal;
    std::vector<uint8_t> mReached;
};

}  // namespace

BlurTiles blurTiles(const EdgeBlur& blur, const View& view) {
    TileGrid grid(view);
    for (const EdgeBlur::Feature& f : blur.features()) {
        if (f.sigma[0] <= 0 && f.sigma[1] <= 0) continue;
        const double reach = kBlurReach * std::max(f.sigma[0], f.sigma[1]) + kSlack;
        if (f.even) {
            grid.add(f.base, reach + f.bend);
            continue;
        }
        for (const EdgeBlur::Segment& chord : f.chords) grid.add(chord, reach + f.flatness);
    }
    BlurTiles tiles;
    grid.appendRuns(false, tiles.rects);
    tiles.plain = tiles.rects.size();
    grid.appendRuns(true, tiles.rects);
    return tiles;
}

}  // namespace tessera::render
