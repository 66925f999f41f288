// Cubic Bezier curves and triangles in the plane (Farin, Curves and Surfaces for CAGD; paper sections 3 and
// 5).
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/lattice.h"

namespace tessera {

// Barycentric parameters (u, v, w) of a patch's corners a, b, c; they add up to 1.
using Barycentric = glm::dvec3;

struct BezierCurve {
    std::array<glm::dvec2, 4> p{};

    glm::dvec2 at(double t) const;
    glm::dvec2 derivative(double t) const;
    BezierCurve reversed() const { return {{p[3], p[2], p[1], p[0]}}; }
    // The part over [t0, t1], as a curve over [0, 1].
    BezierCurve part(double t0, double t1) const;
    double length() const;
};

// The straight segment with its inner control points at the thirds.
BezierCurve straightCurve(glm::dvec2 a, glm::dvec2 b);

// Distance from `point` to the curve, and the parameter of the nearest point.
struct CurveFoot {
    double t = 0;
    double distance = 0;
};
CurveFoot nearestOnCurve(const BezierCurve& curve, glm::dvec2 point);

// Index of control point b_ijk (i + j + k = 3; i counts corner a, j corner b, k corner c) in the order of
// BezierTriangle: the boundary counter-clockwise from a, then the interior point.
//
//            6 c
//          7   5
//        8   9   4
//      0 a 1   2   3 b
constexpr int kInterior = 9;
constexpr int controlIndex(int i, int j, int k) {
    if (i == 1 && j == 1 && k == 1) return kInterior;
    if (k == 0) return j;
    if (i == 0) return 3 + k;
    return 6 + i;
}

// Control points of a cubic triangle: side s (0: ab, 1: bc, 2: ca) is the curve of points 3s .. 3s + 3 (mod
// 9).
template <class Point>
struct CubicTriangle {
    std::array<Point, 10> p{};

    const Point& corner(int s) const { return p[size_t(3 * s)]; }
    std::array<Point, 4> side(int s) const {
        return {p[size_t(3 * s)], p[size_t(3 * s + 1)], p[size_t(3 * s + 2)], p[size_t((3 * s + 3) % 9)]};
    }
};

using BezierTriangle = CubicTriangle<glm::dvec2>;
using LatticeTriangle = CubicTriangle<LatticePoint>;

BezierTriangle toPixels(const LatticeTriangle& t);

// The patch's point at `b`, and its derivatives along b - a and c - a (the columns of the Jacobian in the
// parameters (v, w)).
struct PatchPoint {
    glm::dvec2 position;
    glm::dvec2 dv;
    glm::dvec2 dw;
};
glm::dvec2 evaluate(const BezierTriangle& t, const Barycentric& b);
PatchPoint evaluateWithDerivatives(const BezierTriangle& t, const Barycentric& b);

// One pass of de Casteljau's algorithm at parameters `t` gives the control points of the sub-triangles in
// which one corner is replaced by the point at t: first[corner] is the triangle with that corner replaced
// (paper section 5, Fig. 12; any t with sum 1, also outside the triangle, reproduces the same surface).
std::array<BezierTriangle, 3> deCasteljau(const BezierTriangle& triangle, const Barycentric& t);

// The uniform 4-way subdivision of section 5 by four passes of de Casteljau's algorithm, the last with
// t = (1, -1, 1). Children: at corner a, at b, at c, and the middle one, whose corners are the midpoints of
// sides (ab, bc, ca) in this order.
std::array<BezierTriangle, 4> subdivide4(const BezierTriangle& triangle);

// The interior control point that gives the triangle quadratic precision: the mean of the six side points
// times 3/2 less half the mean of the corners. The usual choice where nothing else determines it.
glm::dvec2 defaultInterior(const BezierTriangle& t);

// The area enclosed by the triangle's boundary curves, positive where it runs from a over b to c in the
// direction of positive orientation. Exact but for rounding in the last place of double.
double signedArea(const BezierTriangle& t);
// The same times 20 in square lattice units, exactly.
int64_t signedArea20(const LatticeTriangle& t);

// The least-squares cubic through `points` with its ends at the first and last of them: chord-length
// parameters, then reparametrized by projection `rounds` times. At least two points.
BezierCurve fitCurve(std::span<const glm::dvec2> points, int rounds = 4);

// Sets the curve's inner control points to those of the least-squares cubic with its ends for points at fixed
// parameters; false, with nothing changed, where the points do not determine them.
bool fitInner(std::span<const glm::dvec2> points, std::span<const double> parameters, BezierCurve& curve);

// The largest distance from one of `points` to the curve.
double maxDistance(const BezierCurve& curve, std::span<const glm::dvec2> points);

}  // namespace tessera
