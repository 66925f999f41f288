// The true-error stage: a triangulation is changed by collapses, splits, flips and moves of vertices, each
// judged by the squared error of the best polynomials over the triangles that it touches.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/mesh/halfedge_mesh.h"
#include "core/mesh/lattice.h"
#include "core/vectorize/initial_mesh.h"
#include "core/vectorize/polynomial_fit.h"

namespace tessera {

struct WorkingMesh {
    HalfedgeMesh mesh;
    std::vector<LatticePoint> positions;  // by vertex
    std::vector<VertexKind> kinds;        // by vertex
};

class Refiner {
  public:
    Refiner(WorkingMesh& work, const PolynomialFit& fit);

    double totalError() const;
    size_t faceCount() const { return m.mesh.faceCount(); }
    size_t fits() const { return 0; }

    bool collapseTo(size_t faces, Progress& progress);
    void splitTo(size_t faces);
    size_t flipPass();
    size_t movePass(double step);

  private:
    struct Triangle {
        VertexId a, b, c;
    };
    // A change of the mesh and what it does to the total error.
    struct Option {
        double gain = 0;
        HalfedgeId halfedge;
    };
    double triangleError(LatticePoint a, LatticePoint b, LatticePoint c) const;
    bool wellShaped(LatticePoint a, LatticePoint b, LatticePoint c) const;
    LatticePoint at(VertexId v) const { return m.positions[v.index]; }
    void updateFace(FaceId f);
    Option bestCollapse(VertexId u) const;
    Option flipGain(EdgeId e) const;
    double splitGain(EdgeId e) const;
    LatticePoint middle(EdgeId e) const;
    bool tryMove(VertexId v, double step);
    template <class Do>
    void touchStar(VertexId v, Do&& visit) const;

    WorkingMesh& m;
    const PolynomialFit& mFit;
    std::vector<double> mError;  // by face
};

}  // namespace tessera
