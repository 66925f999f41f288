// The distance from points to many segments, as far as a given reach.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/patch_mesh.h"

namespace tessera {

using LineSegment = std::pair<glm::dvec2, glm::dvec2>;

// Curves as segments within tolerancePx of them or so.
std::vector<LineSegment> segmentsOf(const PatchMesh& mesh, std::span<const EdgeId> edges,
                                    double tolerancePx = .02);

class DistanceGrid {
  public:
    DistanceGrid(std::vector<LineSegment> segments, double reach);

    // To the nearest segment; `reach` where that is farther, and where there are none. Thread-safe.
    double distance(glm::dvec2 point) const;

  private:
    template <class Visit>
    void forEachCell(const LineSegment& segment, Visit&& visit) const;
    void findEmptyRings();

    std::vector<LineSegment> mSegments;
    double mReach;
    glm::dvec2 mOrigin{0};
    int mColumns = 0, mRows = 0;
    double mCell = 1;
    std::vector<uint32_t> mFirst;  // by cell, into mEntries
    std::vector<uint32_t> mEntries;
    std::vector<uint16_t>
        mEmptyRings;  // by cell: rings of cells around it, itself included, without a segment
};

}  // namespace tessera
