// See distance_grid.h.
#include "core/edit/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera {

namespace {

constexpr double kCellsPerSegment = 4;

double squaredDistance(const LineSegment& segment, glm::dvec2 point) {
    const glm::dvec2 along = segment.second - segment.first;
    const double squared = glm::dot(along, along);
    const double t = squared > 0 ? std::clamp(glm::dot(point - segment.first, along) / squared, 0.0, 1.0) : 0;
    const glm::dvec2 offset = segment.first + t * along - point;
    return glm::dot(offset, offset);
}

}  // namespace

std::vector<LineSegment> segmentsOf(const PatchMesh& mesh, std::span<const EdgeId> edges,
                                    double tolerancePx) {
    constexpr double kMostSegments = 12;
    std::vector<LineSegment> segments;
    for (const EdgeId e : edges) {
        const BezierCurve curve = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        const double bend = std::max(glm::length(curve.p[0] - 2. * curve.p[1] + curve.p[2]),
                                     glm::length(curve.p[1] - 2. * curve.p[2] + curve.p[3]));
        const double count = std::ceil(std::sqrt(.75 * bend / tolerancePx));  // a chord's sagitta
        const int steps = int(std::clamp(count, 1., kMostSegments));
        glm::dvec2 from = curve.p[0];
        for (int i = 1; i <= steps; ++i) {
            const glm::dvec2 to = curve.at(double(i) / steps);
            segments.emplace_back(from, to);
            from = to;
        }
    }
    return segments;
}

// A segment is listed in the cells that it runs through. A point asks rings of cells around its own, from the
// first that has a segment to the first that is farther away than one found.
DistanceGrid::DistanceGrid(std::vector<LineSegment> segments, double reach)
    : mSegments(std::move(segments)), mReach(reach) {
    if (mSegments.empty()) return;
    glm::dvec2 lo = mSegments[0].first, hi = lo;
    for (const LineSegment& s : mSegments) {
        lo = glm::min(lo, glm::min(s.first, s.second));
        hi = glm::max(hi, glm::max(s.first, s.second));
    }
    mOrigin = lo - glm::dvec2(reach);
    const glm::dvec2 size = hi - lo + glm::dvec2(2 * reach);
    constexpr double kMostCells = 1 << 18;
    const double cells = std::min(kMostCells, kCellsPerSegment * double(mSegments.size()));
    mCell = std::max(1.0, std::sqrt(size.x * size.y / cells));
    mColumns = int(size.x / mCell) + 1;
    mRows = int(size.y / mCell) + 1;
    mFirst.assign(size_t(mColumns) * size_t(mRows) + 1, 0);
    for (const LineSegment& s : mSegments) forEachCell(s, [&](size_t cell) { ++mFirst[cell + 1]; });
    for (size_t i = 0; i + 1 < mFirst.size(); ++i) mFirst[i + 1] += mFirst[i];
    mEntries.resize(mFirst.back());
    std::vector<uint32_t> fill(mFirst.begin(), mFirst.end() - 1);
    for (uint32_t s = 0; s < mSegments.size(); ++s)
        forEachCell(mSegments[s], [&](size_t cell) { mEntries[fill[cell]++] = s; });
    findEmptyRings();
}

template <class Visit>
void DistanceGrid::forEachCell(const LineSegment& segment, Visit&& visit) const {
    const auto column = [&](double x) { return std::clamp(int(x), 0, mColumns - 1); };
    glm::dvec2 a = (segment.first - mOrigin) / mCell, b = (segment.second - mOrigin) / mCell;
    if (a.y > b.y) std::swap(a, b);
    const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
    for (int y = int(a.y); y <= std::min(mRows - 1, int(b.y)); ++y) {
        // Where it enters the row, and where it leaves it.
        const double from = y > a.y ? a.x + slope * (y - a.y) : a.x;
        const double to = y + 1 < b.y ? a.x + slope * (y + 1 - a.y) : b.x;
        for (int x = column(std::min(from, to)); x <= column(std::max(from, to)); ++x)
            visit(size_t(y) * size_t(mColumns) + size_t(x));
    }
}

void DistanceGrid::findEmptyRings() {
    const int most = int(mReach / mCell) + 2;
    mEmptyRings.assign(mFirst.size() - 1, uint16_t(std::min(most, int(UINT16_MAX))));
    // As far as a king walks: forth through the rows, and back.
    const auto relax = [&](int x, int y, int step) {
        const size_t cell = size_t(y) * size_t(mColumns) + size_t(x);
        uint16_t& rings = mEmptyRings[cell];
        if (mFirst[cell] < mFirst[cell + 1]) rings = 0;
        const auto look = [&](int nx, int ny) {
            if (nx < 0 || ny < 0 || nx >= mColumns || ny >= mRows) return;
            const int there = mEmptyRings[size_t(ny) * size_t(mColumns) + size_t(nx)];
            rings = uint16_t(std::min<int>(rings, there + 1));
        };
        look(x - step, y);
        for (int dx = -1; dx <= 1; ++dx) look(x + dx, y - step);
    };
    for (int y = 0; y < mRows; ++y)
        for (int x = 0; x < mColumns; ++x) relax(x, y, 1);
    for (int y = mRows - 1; y >= 0; --y)
        for (int x = mColumns - 1; x >= 0; --x) relax(x, y, -1);
}

double DistanceGrid::distance(glm::dvec2 point) const {
    const glm::dvec2 at = (point - mOrigin) / mCell;
    if (mSegments.empty() || !(at.x >= 0 && at.y >= 0 && at.x < mColumns && at.y < mRows)) return mReach;
    const int x = int(at.x), y = int(at.y);
    // From the point to the nearest side of its cell.
    const double inner = mCell * std::min({at.x - x, x + 1 - at.x, at.y - y, y + 1 - at.y});
    double nearest = mReach * mReach;
    const auto look = [&](int column, int row) {
        if (column < 0 || row < 0 || column >= mColumns || row >= mRows) return;
        const size_t cell = size_t(row) * size_t(mColumns) + size_t(column);
        for (uint32_t i = mFirst[cell]; i < mFirst[cell + 1]; ++i)
            nearest = std::min(nearest, squaredDistance(mSegments[mEntries[i]], point));
    };
    for (int r = mEmptyRings[size_t(y) * size_t(mColumns) + size_t(x)];; ++r) {
        const double beyond = inner + (r - 1) * mCell;
        if (r > 0 && beyond * beyond >= nearest) return std::sqrt(nearest);
        for (int column = x - r; column <= x + r; ++column) {
            look(column, y - r);
            if (r > 0) look(column, y + r);
        }
        for (int row = y - r + 1; row < y + r; ++row) {
            look(x - r, row);
            look(x + r, row);
        }
    }
}

}  // namespace tessera
