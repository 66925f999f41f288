// See patch_query.h.
#include "core/mesh/patch_query.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

namespace tessera {

namespace {

constexpr double kConverged = 1e-9;  // of the patch's size

double controlSize(const BezierTriangle& patch) {
    glm::dvec2 lo = patch.p[0], hi = patch.p[0];
    for (const glm::dvec2& p : patch.p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    return std::max(hi.x - lo.x, hi.y - lo.y);
}

// How far parameters lie outside the domain: 0 inside.
double outside(const Barycentric& b) {
    return std::max(0.0, -std::min({b.x, b.y, b.z}));
}

// Newton's method with steps halved until the residual shrinks.
std::optional<Barycentric> newton(const BezierTriangle& patch, glm::dvec2 point, double size,
                                  Barycentric at) {
    constexpr double kTooFar = 2;  // in parameters: other sheets of the cubic begin there
    PatchPoint here = evaluateWithDerivatives(patch, at);
    double residual = glm::distance(here.position, point);
    for (int i = 0; i < 40 && residual > 1e-14 * size; ++i) {
        const double determinant = cross(here.dv, here.dw);
        if (determinant == 0) break;
        const glm::dvec2 r = point - here.position;
        const double stepV = cross(r, here.dw) / determinant, stepW = cross(here.dv, r) / determinant;
        bool better = false;
        for (double share = 1; share > 1e-3 && !better; share *= .5) {
            const double v = at.y + share * stepV, w = at.z + share * stepW;
            const Barycentric trial(1 - v - w, v, w);
            if (outside(trial) > kTooFar) continue;
            const PatchPoint there = evaluateWithDerivatives(patch, trial);
            const double distance = glm::distance(there.position, point);
            if (distance >= residual) continue;
            at = trial;
            here = there;
            residual = distance;
            better = true;
        }
        if (!better) break;
    }
    if (!(residual <= kConverged * size)) return std::nullopt;
    return at;
}

// Parameters whose point is nearest to `point`, on a lattice of 15 over the domain; the `count` nearest of
// them, in order.
template <size_t kCount>
std::array<Barycentric, kCount> nearestStarts(const BezierTriangle& patch, glm::dvec2 point) {
    std::array<std::pair<double, Barycentric>, 15> all;
    size_t n = 0;
    for (int j = 0; j <= 4; ++j)
        for (int k = 0; j + k <= 4; ++k) {
            // Pulled inwards a little: at a corner or side the map may be near singular.
            const double v = 1.0 / 60 + .95 * j / 4, w = 1.0 / 60 + .95 * k / 4;
            const Barycentric b(1 - v - w, v, w);
            all[n++] = {glm::distance(evaluate(patch, b), point), b};
        }
    std::partial_sort(all.begin(), all.begin() + kCount, all.end(),
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    std::array<Barycentric, kCount> starts;
    for (size_t i = 0; i < kCount; ++i) starts[i] = all[i].second;
    return starts;
}

}  // namespace

std::optional<Barycentric> invert(const BezierTriangle& patch, glm::dvec2 point) {
    const double size = controlSize(patch);
    if (!(size > 0)) return std::nullopt;
    std::optional<Barycentric> best;
    const auto settled = [&](const std::optional<Barycentric>& found) {
        if (found && (!best || outside(*found) < outside(*best))) best = found;
        return best && outside(*best) <= kConverged;
    };
    // The base triangle's parameters first: for most patches they are near.
    const glm::dvec2 ab = patch.p[3] - patch.p[0], ac = patch.p[6] - patch.p[0], ap = point - patch.p[0];
    const double base = cross(ab, ac);
    if (base != 0) {
        const double v = cross(ap, ac) / base, w = cross(ab, ap) / base;
        if (outside({1 - v - w, v, w}) < 1 && settled(newton(patch, point, size, {1 - v - w, v, w})))
            return best;
    }
    for (const Barycentric& start : nearestStarts<5>(patch, point))
        if (settled(newton(patch, point, size, start))) break;
    return best;
}

Barycentric nearestParameters(const BezierTriangle& patch, glm::dvec2 point, double tolerance) {
    if (const auto found = invert(patch, point)) {
        if (outside(*found) == 0) return *found;
        Barycentric inside = glm::max(*found, Barycentric(0));
        inside /= inside.x + inside.y + inside.z;
        if (glm::distance(evaluate(patch, inside), point) <= tolerance) return inside;
    }
    // Outside for good: the nearest point of the three sides.
    Barycentric best(1, 0, 0);
    double distance = std::numeric_limits<double>::infinity();
    for (int s = 0; s < 3; ++s) {
        const CurveFoot foot = nearestOnCurve(BezierCurve{patch.side(s)}, point);
        if (foot.distance >= distance) continue;
        distance = foot.distance;
        best = Barycentric(0);
        best[s] = 1 - foot.t;
        best[(s + 1) % 3] = foot.t;
    }
    return best;
}

Rect controlBounds(const PatchMesh& mesh, PatchId p) {
    const LatticeTriangle t = mesh.controlPoints(p);
    LatticePoint lo = t.p[0], hi = t.p[0];
    for (const LatticePoint& q : t.p) {
        lo = {std::min(lo.x, q.x), std::min(lo.y, q.y)};
        hi = {std::max(hi.x, q.x), std::max(hi.y, q.y)};
    }
    return {toPixels(lo), toPixels(hi)};
}

namespace {

bool meets(const Rect& a, const Rect& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

struct CellRange {
    int x0, y0, x1, y1;  // inclusive
};

// Cells beyond the grid count as its outermost ones: control points may lie outside the picture.
CellRange cellsOf(const Rect& r, double cellSize, int columns, int rows) {
    const auto cell = [&](double x, int count) {
        return int(std::clamp(std::floor(x / cellSize), 0.0, double(count - 1)));
    };
    return {cell(r.min.x, columns), cell(r.min.y, rows), cell(r.max.x, columns), cell(r.max.y, rows)};
}

}  // namespace

PatchQuery::PatchQuery(PatchMesh mesh) : mMesh(std::move(mesh)) {
    const double area = double(mMesh.width()) * mMesh.height();
    const double perPatch = area / double(std::max<size_t>(1, mMesh.patchCount()));
    mCellSize = std::max(1.0, std::sqrt(std::max(perPatch, 1e-9)));
    mColumns = std::max(1, int(std::ceil(mMesh.width() / mCellSize)));
    mRows = std::max(1, int(std::ceil(mMesh.height() / mCellSize)));
    mFirst.assign(size_t(mColumns) * size_t(mRows) + 1, 0);
    const auto forEachCell = [&](PatchId p, auto&& visit) {
        const CellRange c = cellsOf(controlBounds(mMesh, p), mCellSize, mColumns, mRows);
        for (int y = c.y0; y <= c.y1; ++y)
            for (int x = c.x0; x <= c.x1; ++x) visit(size_t(y) * size_t(mColumns) + size_t(x));
    };
    mMesh.forEachPatch([&](PatchId p) { forEachCell(p, [&](size_t cell) { ++mFirst[cell + 1]; }); });
    for (size_t i = 0; i + 1 < mFirst.size(); ++i) mFirst[i + 1] += mFirst[i];
    mPatches.resize(mFirst.back());
    std::vector<uint32_t> fill(mFirst.begin(), mFirst.end() - 1);
    mMesh.forEachPatch([&](PatchId p) { forEachCell(p, [&](size_t cell) { mPatches[fill[cell]++] = p; }); });
}

std::vector<PatchId> PatchQuery::patchesIn(const Rect& rect) const {
    const CellRange c = cellsOf(rect, mCellSize, mColumns, mRows);
    std::vector<PatchId> result;
    for (int y = c.y0; y <= c.y1; ++y)
        for (int x = c.x0; x <= c.x1; ++x) {
            const size_t cell = size_t(y) * size_t(mColumns) + size_t(x);
            result.insert(result.end(), mPatches.begin() + mFirst[cell], mPatches.begin() + mFirst[cell + 1]);
        }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    std::erase_if(result, [&](PatchId p) { return !meets(controlBounds(mMesh, p), rect); });
    return result;
}

std::optional<PatchHit> PatchQuery::patchAt(glm::dvec2 point) const {
    if (!(point.x >= 0 && point.y >= 0 && point.x <= mMesh.width() && point.y <= mMesh.height()))
        return std::nullopt;
    // Newton's result for a point on a side is off it by rounding; on a shared edge both patches then count.
    constexpr double kOnSide = 1e-9, kAlmost = 1e-6;
    std::optional<PatchHit> best;
    double bestOutside = kAlmost;
    for (const PatchId p : patchesIn({point, point})) {
        const auto at = invert(toPixels(mMesh.controlPoints(p)), point);
        if (!at || outside(*at) >= bestOutside) continue;
        best = PatchHit{p, *at};
        bestOutside = outside(*at);
        if (bestOutside <= kOnSide) break;
    }
    return best;
}

std::vector<PatchId> PatchQuery::patchesInPolygon(std::span<const glm::dvec2> polygon) const {
    if (polygon.size() < 3) return {};
    Rect box{polygon[0], polygon[0]};
    for (const glm::dvec2& p : polygon) box = {glm::min(box.min, p), glm::max(box.max, p)};
    std::vector<PatchId> result = patchesIn(box);
    std::erase_if(result, [&](PatchId p) {
        const glm::dvec2 at = evaluate(toPixels(mMesh.controlPoints(p)), Barycentric(1.0 / 3));
        bool in = false;
        for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
            const glm::dvec2 a = polygon[j], b = polygon[i];
            if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y))
                in = !in;
        }
        return !in;
    });
    return result;
}

std::optional<ControlPointHit> PatchQuery::nearestControlPoint(glm::dvec2 point, double radius) const {
    using Kind = ControlPointHit::Kind;
    std::optional<ControlPointHit> best;
    const auto rank = [](const ControlPointHit& h) {
        const uint32_t id = h.kind == Kind::Vertex       ? h.vertex.index
                            : h.kind == Kind::CurveInner ? h.halfedge.index
                                                         : h.patch.index;
        return std::tuple(h.distance, h.kind, id);
    };
    const auto consider = [&](ControlPointHit hit, LatticePoint at) {
        hit.distance = glm::distance(toPixels(at), point);
        if (hit.distance <= radius && (!best || rank(hit) < rank(*best))) best = hit;
    };
    const HalfedgeMesh& c = mMesh.connectivity();
    for (const PatchId p : patchesIn({point - glm::dvec2(radius), point + glm::dvec2(radius)})) {
        for (const HalfedgeId side : c.sides(p)) {
            consider({Kind::Vertex, c.origin(side), {}, {}, 0}, mMesh.position(c.origin(side)));
            for (const HalfedgeId h : {side, HalfedgeMesh::twin(side)})
                consider({Kind::CurveInner, {}, h, {}, 0}, mMesh.controlPoints(h)[1]);
        }
        consider({Kind::Interior, {}, {}, p, 0}, mMesh.interior(p));
    }
    return best;
}

std::optional<CurveHit> PatchQuery::nearestCurve(glm::dvec2 point, double radius) const {
    std::optional<CurveHit> best;
    for (const PatchId p : patchesIn({point - glm::dvec2(radius), point + glm::dvec2(radius)}))
        for (const HalfedgeId side : mMesh.connectivity().sides(p)) {
            const EdgeId e = HalfedgeMesh::edge(side);
            const CurveFoot foot =
                nearestOnCurve(toPixels(mMesh.controlPoints(HalfedgeMesh::halfedge(e))), point);
            if (foot.distance > radius) continue;
            if (!best || std::tuple(foot.distance, e) < std::tuple(best->distance, best->edge))
                best = CurveHit{e, foot.t, foot.distance};
        }
    return best;
}

}  // namespace tessera
