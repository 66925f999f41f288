// Constrained Delaunay triangulation of lattice points in a rectangle, with exact predicates: insertion with
// flips (Lawson 1977), constraints by flipping what crosses them (Sloan 1993).
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/halfedge_mesh.h"
#include "core/mesh/lattice.h"

namespace tessera {

class Delaunay {
  public:
    // The rectangle from (0, 0) to `extent`, cut in two: vertices 0 .. 3 are its corners.
    explicit Delaunay(LatticePoint extent);

    // The vertex at `p`, which lies in the rectangle: a new one or the one that is there. None where `p` lies
    // inside a constrained edge.
    VertexId insert(LatticePoint p);
    // Makes a -> b an edge that stays. No vertex may lie between a and b and no constrained edge may cross;
    // returns none where that is so. What crossed it is Delaunay again afterwards.
    EdgeId constrain(VertexId a, VertexId b);

    const HalfedgeMesh& mesh() const { return mMesh; }
    const std::vector<LatticePoint>& positions() const { return mPositions; }
    bool constrained(EdgeId e) const { return mConstrained[e.index] != 0; }

  private:
    int64_t orientation(VertexId a, VertexId b, LatticePoint p) const;
    LatticePoint at(VertexId v) const { return mPositions[v.index]; }
    // A face that holds p (or has it on a side), walking from the last one.
    FaceId locate(LatticePoint p);
    bool flippable(EdgeId e) const;
    bool wantsFlip(EdgeId e) const;
    void legalize(std::vector<EdgeId>& stack);

    HalfedgeMesh mMesh;
    std::vector<LatticePoint> mPositions;
    std::vector<uint8_t> mConstrained;  // by edge
    FaceId mLast{0};
};

}  // namespace tessera
