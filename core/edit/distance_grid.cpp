// See distance_grid.h.
#include "core/edit/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera {

namespace {

double distanceTo(const LineSegment& segment, glm::dvec2 point) {
    const glm::dvec2 along = segment.second - segment.first;
    const double squared = glm::dot(along, along);
    const double t = squared > 0 ? std::clamp(glm::dot(point - segment.first, along) / squared, 0.0, 1.0) : 0;
    return glm::distance(segment.first + t * along, point);
}

}  // namespace

std::vector<LineSegment> segmentsOf(const PatchMesh& mesh, std::span<const EdgeId> edges) {
    constexpr int kSegments = 12;
    std::vector<LineSegment> segments;
    for (const EdgeId e : edges) {
        const BezierCurve curve = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        glm::dvec2 from = curve.p[0];
        for (int i = 1; i <= kSegments; ++i) {
            const glm::dvec2 to = curve.at(double(i) / kSegments);
            segments.emplace_back(from, to);
            from = to;
        }
    }
    return segments;
}

// A segment is listed in all cells that its box, grown by the reach, meets: a point asks its own cell alone.
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
    constexpr double kMostCells = 1 << 16;
    mCell = std::max({1.0, reach / 2, std::sqrt(size.x * size.y / kMostCells)});
    mColumns = int(size.x / mCell) + 1;
    mRows = int(size.y / mCell) + 1;
    const auto forEachCell = [&](const LineSegment& s, auto&& visit) {
        const glm::dvec2 from = (glm::min(s.first, s.second) - glm::dvec2(reach) - mOrigin) / mCell;
        const glm::dvec2 to = (glm::max(s.first, s.second) + glm::dvec2(reach) - mOrigin) / mCell;
        for (int y = std::max(0, int(from.y)); y <= std::min(mRows - 1, int(to.y)); ++y)
            for (int x = std::max(0, int(from.x)); x <= std::min(mColumns - 1, int(to.x)); ++x)
                visit(size_t(y) * size_t(mColumns) + size_t(x));
    };
    mFirst.assign(size_t(mColumns) * size_t(mRows) + 1, 0);
    for (const LineSegment& s : mSegments) forEachCell(s, [&](size_t cell) { ++mFirst[cell + 1]; });
    for (size_t i = 0; i + 1 < mFirst.size(); ++i) mFirst[i + 1] += mFirst[i];
    mEntries.resize(mFirst.back());
    std::vector<uint32_t> fill(mFirst.begin(), mFirst.end() - 1);
    for (uint32_t s = 0; s < mSegments.size(); ++s)
        forEachCell(mSegments[s], [&](size_t cell) { mEntries[fill[cell]++] = s; });
}

double DistanceGrid::distance(glm::dvec2 point) const {
    const glm::dvec2 at = (point - mOrigin) / mCell;
    if (mSegments.empty() || !(at.x >= 0 && at.y >= 0 && at.x < mColumns && at.y < mRows)) return mReach;
    const size_t cell = size_t(at.y) * size_t(mColumns) + size_t(at.x);
    double nearest = mReach;
    for (uint32_t i = mFirst[cell]; i < mFirst[cell + 1]; ++i)
        nearest = std::min(nearest, distanceTo(mSegments[mEntries[i]], point));
    return nearest;
}

}  // namespace tessera
