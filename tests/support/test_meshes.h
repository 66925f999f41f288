// Small meshes made by hand for geometry tests.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "core/mesh/jacobian.h"
#include "core/mesh/patch_mesh.h"

namespace tessera::testing {

// A grid of columns x rows cells over the picture, two triangles each, all straight; black.
inline PatchMesh gridMesh(int width, int height, int columns, int rows, int channels = 3) {
    std::vector<LatticePoint> positions;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            positions.push_back(
                {width * kLatticePerPixel * i / columns, height * kLatticePerPixel * j / rows});
    std::vector<std::array<uint32_t, 3>> triangles;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto a = uint32_t(j * (columns + 1) + i), b = a + 1, c = a + uint32_t(columns) + 1,
                       d = c + 1;
            triangles.push_back({a, b, d});
            triangles.push_back({a, d, c});
        }
    return PatchMesh(width, height, channels, HalfedgeMesh::fromTriangles(positions.size(), triangles),
                     positions);
}

// A random spline of 16 terms and `channels` channels with values near 0..1, side conditions fulfilled.
inline PatchSpline randomSpline(int channels, std::mt19937& random) {
    std::uniform_real_distribution<double> value(0, 1);
    const NodalBasis& basis = defaultNodalBasis();
    PatchSpline spline;
    for (int c = 0; c < channels; ++c) {
        std::vector<double> nodal(size_t(basis.n));
        const double base = value(random);
        for (double& v : nodal) v = .7 * base + .3 * value(random);
        spline.terms[size_t(c)] = uint8_t(basis.n);
        for (int r = 0; r < basis.n + 3; ++r) {
            double sum = 0;
            for (int i = 0; i < basis.n; ++i)
                sum += basis.toCoefficients[size_t(r * basis.n + i)] * nodal[size_t(i)];
            spline.coefficients.push_back(float(sum));
        }
    }
    return spline;
}

// gridMesh with its inner vertices moved, its inner edges bent (each as far as both patches stay certified),
// random colours, and every third inner edge marked as a feature. The same for the same seed.
inline PatchMesh curvedMesh(int width, int height, int columns, int rows, unsigned seed, int channels = 3) {
    PatchMesh mesh = gridMesh(width, height, columns, rows, channels);
    const HalfedgeMesh& c = mesh.connectivity();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const double cellX = double(width) / columns, cellY = double(height) / rows;
    mesh.forEachVertex([&](VertexId v) {
        if (c.onBorder(v)) return;
        mesh.setPosition(
            v, mesh.position(v) + toLattice({.18 * cellX * unit(random), .18 * cellY * unit(random)}));
    });
    mesh.forEachEdge([&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const auto inner = straightControlPoints(mesh.position(c.origin(h)), mesh.position(c.target(h)));
        mesh.setInnerControlPoints(h, inner[0], inner[1]);
    });
    mesh.forEachPatch([&](PatchId p) {
        mesh.setInterior(p, toLattice(defaultInterior(toPixels(mesh.controlPoints(p)))));
        mesh.setSpline(p, randomSpline(channels, random));
    });
    mesh.forEachEdge([&](EdgeId e) {
        if (c.onBorder(e)) return;
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const auto straight = mesh.controlPoints(h);
        const LatticePoint bend1 = toLattice({.3 * cellX * unit(random), .3 * cellY * unit(random)});
        const LatticePoint bend2 = toLattice({.3 * cellX * unit(random), .3 * cellY * unit(random)});
        for (int divisor = 1; divisor <= 16; divisor *= 2) {
            PatchMesh trial = mesh;
            trial.setInnerControlPoints(h, straight[1] + LatticePoint{bend1.x / divisor, bend1.y / divisor},
                                        straight[2] + LatticePoint{bend2.x / divisor, bend2.y / divisor});
            bool good = true;
            for (const PatchId p : {c.face(h), c.face(HalfedgeMesh::twin(h))}) {
                const auto interior = certifiedInterior(trial.controlPoints(p));
                good = good && interior;
                if (interior) trial.setInterior(p, *interior);
            }
            if (!good) continue;
            mesh = trial;
            break;
        }
        EdgeCurve curve = mesh.curve(e);
        curve.feature = e.index % 3 == 0;
        mesh.setCurve(e, curve);
    });
    return mesh;
}

}  // namespace tessera::testing
