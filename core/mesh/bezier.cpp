// See bezier.h.
#include "core/mesh/bezier.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/check.h"

namespace tessera {

glm::dvec2 BezierCurve::at(double t) const {
    const double s = 1 - t;
    return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
}

glm::dvec2 BezierCurve::derivative(double t) const {
    const double s = 1 - t;
    return 3.0 * (s * s * (p[1] - p[0]) + 2 * s * t * (p[2] - p[1]) + t * t * (p[3] - p[2]));
}

BezierCurve BezierCurve::part(double t0, double t1) const {
    // Blossoming: control point k of the part is the polar form at (3 - k) times t0 and k times t1.
    const auto blossom = [&](double r, double s, double t) {
        const auto lerp = [](glm::dvec2 a, glm::dvec2 b, double x) { return (1 - x) * a + x * b; };
        const glm::dvec2 a = lerp(p[0], p[1], r), b = lerp(p[1], p[2], r), c = lerp(p[2], p[3], r);
        return lerp(lerp(a, b, s), lerp(b, c, s), t);
    };
    return {{blossom(t0, t0, t0), blossom(t0, t0, t1), blossom(t0, t1, t1), blossom(t1, t1, t1)}};
}

double BezierCurve::length() const {
    // Gauss-Legendre with 5 nodes: ample for the gentle curves of patch sides.
    constexpr double kNode[] = {-.9061798459386640, -.5384693101056831, 0, .5384693101056831,
                                .9061798459386640};
    constexpr double kWeight[] = {.2369268850561891, .4786286704993665, .5688888888888889, .4786286704993665,
                                  .2369268850561891};
    double sum = 0;
    for (int i = 0; i < 5; ++i) sum += kWeight[i] * glm::length(derivative(.5 + .5 * kNode[i]));
    return .5 * sum;
}

BezierCurve straightCurve(glm::dvec2 a, glm::dvec2 b) {
    return {{a, (2.0 * a + b) / 3.0, (a + 2.0 * b) / 3.0, b}};
}

CurveFoot nearestOnCurve(const BezierCurve& curve, glm::dvec2 point) {
    constexpr int kStarts = 8;
    CurveFoot best{0, glm::distance(curve.p[0], point)};
    const auto consider = [&](double t) {
        const double d = glm::distance(curve.at(t), point);
        if (d < best.distance) best = {t, d};
    };
    for (int i = 1; i <= kStarts; ++i) consider(double(i) / kStarts);
    // Newton on (B(t) - point) . B'(t) from the best sample, kept inside its neighbours' interval.
    const double lo = std::max(0.0, best.t - 1.0 / kStarts), hi = std::min(1.0, best.t + 1.0 / kStarts);
    double t = best.t;
    for (int i = 0; i < 6; ++i) {
        const glm::dvec2 r = curve.at(t) - point, d = curve.derivative(t);
        const double s = 1 - t;
        const glm::dvec2 d2 = 6.0 * (s * (curve.p[2] - 2.0 * curve.p[1] + curve.p[0]) +
                                     t * (curve.p[3] - 2.0 * curve.p[2] + curve.p[1]));
        const double slope = glm::dot(d, d) + glm::dot(r, d2);
        const double curvature = slope > 0 ? slope : glm::dot(d, d);
        if (curvature <= 0) break;
        t = std::clamp(t - glm::dot(r, d) / curvature, lo, hi);
        consider(t);
    }
    return best;
}

BezierTriangle toPixels(const LatticeTriangle& t) {
    BezierTriangle r;
    for (size_t i = 0; i < 10; ++i) r.p[i] = toPixels(t.p[i]);
    return r;
}

glm::dvec2 evaluate(const BezierTriangle& t, const Barycentric& b) {
    return evaluateWithDerivatives(t, b).position;
}

PatchPoint evaluateWithDerivatives(const BezierTriangle& t, const Barycentric& b) {
    const auto& p = t.p;
    const double u = b.x, v = b.y, w = b.z;
    // One step of de Casteljau: the six points of the quadratic at b.
    const glm::dvec2 q200 = u * p[0] + v * p[1] + w * p[8];
    const glm::dvec2 q110 = u * p[1] + v * p[2] + w * p[9];
    const glm::dvec2 q020 = u * p[2] + v * p[3] + w * p[4];
    const glm::dvec2 q011 = u * p[9] + v * p[4] + w * p[5];
    const glm::dvec2 q002 = u * p[7] + v * p[5] + w * p[6];
    const glm::dvec2 q101 = u * p[8] + v * p[9] + w * p[7];
    const glm::dvec2 r100 = u * q200 + v * q110 + w * q101;
    const glm::dvec2 r010 = u * q110 + v * q020 + w * q011;
    const glm::dvec2 r001 = u * q101 + v * q011 + w * q002;
    return {u * r100 + v * r010 + w * r001, 3.0 * (r010 - r100), 3.0 * (r001 - r100)};
}

std::array<BezierTriangle, 3> deCasteljau(const BezierTriangle& triangle, const Barycentric& t) {
    // level[l] holds the points of order 3 - l; the sub-triangles collect those on the sides of the
    // tetrahedral scheme.
    glm::dvec2 level[4][4][4];  // [l][i][j], k = 3 - l - i - j
    for (int i = 0; i <= 3; ++i)
        for (int j = 0; i + j <= 3; ++j) level[0][i][j] = triangle.p[size_t(controlIndex(i, j, 3 - i - j))];
    for (int l = 1; l <= 3; ++l)
        for (int i = 0; i <= 3 - l; ++i)
            for (int j = 0; i + j <= 3 - l; ++j)
                level[l][i][j] =
                    t.x * level[l - 1][i + 1][j] + t.y * level[l - 1][i][j + 1] + t.z * level[l - 1][i][j];
    std::array<BezierTriangle, 3> result;
    for (int i = 0; i <= 3; ++i)
        for (int j = 0; i + j <= 3; ++j) {
            const int k = 3 - i - j;
            const auto index = size_t(controlIndex(i, j, k));
            result[0].p[index] = level[i][0][j];  // a replaced: the new corner's share i is the level
            result[1].p[index] = level[j][i][0];
            result[2].p[index] = level[k][i][j];
        }
    return result;
}

std::array<BezierTriangle, 4> subdivide4(const BezierTriangle& abc) {
    const Barycentric half(.5, .5, 0);
    // With t on side ab at i: b replaced gives (a, i, c), a replaced gives (i, b, c).
    const auto atI = deCasteljau(abc, half);
    const BezierTriangle& aic = atI[1];
    const BezierTriangle& ibc = atI[0];
    // Rotated so that the side to be halved comes first: (c, a, i) at k on ca, (b, c, i) at j on bc.
    const auto rotate = [](const BezierTriangle& t, int by) {  // corner `by` becomes the first
        BezierTriangle r;
        for (int n = 0; n < 9; ++n) r.p[size_t(n)] = t.p[size_t((n + 3 * by) % 9)];
        r.p[kInterior] = t.p[kInterior];
        return r;
    };
    const auto atK = deCasteljau(rotate(aic, 2), half);  // of (c, a, i)
    const BezierTriangle kai = atK[0];
    const auto atJ = deCasteljau(rotate(ibc, 1), half);  // of (b, c, i)
    const BezierTriangle bji = atJ[1];
    const BezierTriangle jci = atJ[0];
    // (i, j, c) extrapolated to k = i - j + c gives (k, j, c) with i replaced and (i, j, k) with c replaced.
    const auto atLast = deCasteljau(rotate(jci, 2), Barycentric(1, -1, 1));  // of (i, j, c)
    return {rotate(kai, 1), rotate(bji, 2) /* (i, b, j) */, rotate(atLast[0], 0) /* (k, j, c) */,
            atLast[2] /* (i, j, k) */};
}

glm::dvec2 defaultInterior(const BezierTriangle& t) {
    const auto& p = t.p;
    return (p[1] + p[2] + p[4] + p[5] + p[7] + p[8]) / 4.0 - (p[0] + p[3] + p[6]) / 6.0;
}

namespace {

// Twenty times the integral of (x dy - y dx) / 2 along a cubic: an integer combination of its control points'
// cross products (Green's theorem; each product of Bernstein polynomials integrated exactly).
template <class Scalar, class Point>
Scalar curveArea20(const std::array<Point, 4>& q) {
    return 6 * cross(q[0], q[1]) + 3 * cross(q[0], q[2]) + cross(q[0], q[3]) + 3 * cross(q[1], q[2]) +
           3 * cross(q[1], q[3]) + 6 * cross(q[2], q[3]);
}

}  // namespace

double signedArea(const BezierTriangle& t) {
    double sum = 0;
    for (int s = 0; s < 3; ++s) sum += curveArea20<double>(t.side(s));
    return sum / 20;
}

int64_t signedArea20(const LatticeTriangle& t) {
    int64_t sum = 0;
    for (int s = 0; s < 3; ++s) sum += curveArea20<int64_t>(t.side(s));
    return sum;
}

bool fitInner(std::span<const glm::dvec2> points, std::span<const double> parameters, BezierCurve& curve) {
    double a11 = 0, a12 = 0, a22 = 0;
    glm::dvec2 r1(0), r2(0);
    for (size_t i = 0; i < points.size(); ++i) {
        const double t = parameters[i], s = 1 - t;
        const double b1 = 3 * s * s * t, b2 = 3 * s * t * t;
        const glm::dvec2 rest = points[i] - s * s * s * curve.p[0] - t * t * t * curve.p[3];
        a11 += b1 * b1;
        a12 += b1 * b2;
        a22 += b2 * b2;
        r1 += b1 * rest;
        r2 += b2 * rest;
    }
    const double determinant = a11 * a22 - a12 * a12;
    if (determinant <= 1e-9 * a11 * a22) return false;
    curve.p[1] = (a22 * r1 - a12 * r2) / determinant;
    curve.p[2] = (a11 * r2 - a12 * r1) / determinant;
    return true;
}

BezierCurve fitCurve(std::span<const glm::dvec2> points, int rounds) {
    TESSERA_CHECK(points.size() >= 2);
    const BezierCurve straight = straightCurve(points.front(), points.back());
    if (points.size() == 2) return straight;

    std::vector<double> parameters(points.size(), 0);
    for (size_t i = 1; i < points.size(); ++i)
        parameters[i] = parameters[i - 1] + glm::distance(points[i - 1], points[i]);
    if (parameters.back() <= 0) return straight;
    const double total = parameters.back();
    for (double& t : parameters) t /= total;

    // A few points leave the inner control points underdetermined: two samples of each chord settle them.
    std::vector<glm::dvec2> dense;
    if (points.size() < 5) {
        std::vector<double> denseParameters;
        for (size_t i = 0; i + 1 < points.size(); ++i)
            for (int k = 0; k < 4; ++k) {
                dense.push_back(points[i] + (points[i + 1] - points[i]) * (k / 4.0));
                denseParameters.push_back(parameters[i] + (parameters[i + 1] - parameters[i]) * (k / 4.0));
            }
        dense.push_back(points.back());
        denseParameters.push_back(1);
        points = dense;
        parameters = std::move(denseParameters);
    }

    BezierCurve curve = straight;
    if (!fitInner(points, parameters, curve)) return straight;
    for (int round = 0; round < rounds; ++round) {
        // Gauss-Newton reparametrization: each point moves to its foot on the tangent, order kept.
        std::vector<double> moved(parameters);
        for (size_t i = 1; i + 1 < points.size(); ++i) {
            const glm::dvec2 d = curve.derivative(parameters[i]);
            const double dd = glm::dot(d, d);
            if (dd <= 0) continue;
            moved[i] -= glm::dot(curve.at(parameters[i]) - points[i], d) / dd;
            moved[i] = std::clamp(moved[i], 0.0, 1.0);
        }
        if (!std::is_sorted(moved.begin(), moved.end())) break;
        BezierCurve next = curve;
        if (!fitInner(points, moved, next)) break;
        curve = next;
        parameters = std::move(moved);
    }
    return curve;
}

double maxDistance(const BezierCurve& curve, std::span<const glm::dvec2> points) {
    double largest = 0;
    for (const glm::dvec2& point : points) largest = std::max(largest, nearestOnCurve(curve, point).distance);
    return largest;
}

}  // namespace tessera
