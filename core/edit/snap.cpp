// See snap.h.
#include "core/edit/snap.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <vector>

#include "core/edit/deformation.h"
#include "core/edit/reshape.h"

namespace tessera {

namespace {

constexpr double kStepPx = .25;  // along a normal

// How much the photo changes across a place, over about a pixel and a half, all channels together.
double steepness(const Image& photo, glm::dvec2 at, glm::dvec2 normal) {
    constexpr double kHalf = .75;
    const glm::dvec2 a = at - kHalf * normal, b = at + kHalf * normal;
    double sum = 0;
    for (int c = 0; c < photo.channels(); ++c) {
        const double d = double(bilinear(photo, c, b.x, b.y) - bilinear(photo, c, a.x, a.y));
        sum += d * d;
    }
    return std::sqrt(sum);
}

// Points along a curve, each with how far along its normal the photo's edge lies.
struct Snapped {
    std::vector<double> t;
    std::vector<glm::dvec2> to;
};

// The path through the profiles along the normals that is steep and even: the best by dynamic programming.
std::vector<int> bestPath(const std::vector<std::vector<double>>& profiles) {
    constexpr double kUnevenness = .02;  // of a step between neighbours, against a steepness of 1
    constexpr int kMostStep = 3;
    const int offsets = int(profiles[0].size());
    std::vector<std::vector<int>> from(profiles.size(), std::vector<int>(size_t(offsets), 0));
    std::vector<double> score = profiles[0];
    for (size_t i = 1; i < profiles.size(); ++i) {
        std::vector<double> next(size_t(offsets), 0);
        for (int k = 0; k < offsets; ++k) {
            double best = -HUGE_VAL;
            for (int step = -kMostStep; step <= kMostStep; ++step) {
                const int before = k + step;
                if (before < 0 || before >= offsets) continue;
                const double value = score[size_t(before)] - kUnevenness * step * step;
                if (value <= best) continue;
                best = value;
                from[i][size_t(k)] = before;
            }
            next[size_t(k)] = best + profiles[i][size_t(k)];
        }
        score = std::move(next);
    }
    std::vector<int> path(profiles.size());
    path.back() = int(std::max_element(score.begin(), score.end()) - score.begin());
    for (size_t i = profiles.size() - 1; i > 0; --i) path[i - 1] = from[i][size_t(path[i])];
    return path;
}

// Where between its neighbours a maximum lies, in steps.
double peak(const std::vector<double>& profile, int at) {
    if (at <= 0 || at + 1 >= int(profile.size())) return 0;
    const double a = profile[size_t(at - 1)], b = profile[size_t(at)], c = profile[size_t(at + 1)];
    const double bend = a - 2 * b + c;
    return bend < 0 ? std::clamp(.5 * (a - c) / bend, -.5, .5) : 0;
}

std::optional<Snapped> findEdge(const Image& photo, const BezierCurve& curve, double reachPx) {
    constexpr double kLeastSteepness = 5.0 / 255;
    constexpr int kLeast = 9, kMost = 65;
    const int samples = std::clamp(int(curve.length()) + 1, kLeast, kMost);
    const int half = int(std::lround(reachPx / kStepPx));
    std::vector<std::vector<double>> profiles, scores;
    std::vector<glm::dvec2> points, normals;
    Snapped result;
    for (int i = 0; i < samples; ++i) {
        const double t = double(i) / (samples - 1);
        const glm::dvec2 at = curve.at(t), along = curve.derivative(std::clamp(t, .01, .99));
        if (glm::length(along) <= 0) return std::nullopt;
        const glm::dvec2 normal = glm::normalize(glm::dvec2(-along.y, along.x));
        auto& profile = profiles.emplace_back();
        auto& score = scores.emplace_back();
        for (int k = -half; k <= half; ++k) {
            profile.push_back(steepness(photo, at + k * kStepPx * normal, normal));
            // Of two alike the nearer one.
            score.push_back(profile.back() * (1 - .3 * std::abs(k) / half));
        }
        result.t.push_back(t);
        points.push_back(at);
        normals.push_back(normal);
    }
    const std::vector<int> path = bestPath(scores);
    int seen = 0;
    for (size_t i = 0; i < path.size(); ++i) {
        seen += profiles[i][size_t(path[i])] >= kLeastSteepness;
        const double offset = (path[i] - half + peak(profiles[i], path[i])) * kStepPx;
        result.to.push_back(points[i] + offset * normals[i]);
    }
    if (2 * seen < samples) return std::nullopt;
    return result;
}

using Targets = std::map<ControlPointRef, glm::dvec2>;

// Handles on both sides of a join get its mean tangent.
void joinTangents(const PatchMesh& mesh, Targets& targets) {
    std::vector<VertexId> vertices;
    for (const auto& [ref, to] : targets)
        if (ref.kind == ControlPointHit::Kind::Vertex) vertices.push_back(ref.vertex);
    for (const VertexId v : vertices) {
        const auto join = impliedJoin(mesh, v);
        if (!join) continue;
        const auto first = targets.find(ControlPointRef::of(leaving(mesh.connectivity(), join->first, v)));
        const auto second = targets.find(ControlPointRef::of(leaving(mesh.connectivity(), join->second, v)));
        if (first == targets.end() || second == targets.end()) continue;
        const glm::dvec2 at = targets[ControlPointRef::of(v)];
        const double one = glm::distance(first->second, at), other = glm::distance(second->second, at);
        if (!(one > 0 && other > 0)) continue;
        const glm::dvec2 along = (second->second - at) / other - (first->second - at) / one;
        if (!(glm::length(along) > 0)) continue;
        first->second = at - one * glm::normalize(along);
        second->second = at + other * glm::normalize(along);
    }
}

Targets findTargets(const PatchMesh& mesh, const Image& photo, std::span<const EdgeId> edges,
                    double reachPx) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::map<EdgeId, Snapped> snapped;
    std::map<VertexId, std::pair<glm::dvec2, int>> ends;  // sums
    for (const EdgeId e : edges) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const auto found = findEdge(photo, toPixels(mesh.controlPoints(h)), reachPx);
        if (!found || c.onBorder(e)) continue;
        const auto add = [&](VertexId v, glm::dvec2 to) {
            auto& [sum, count] = ends[v];
            sum += to;
            ++count;
        };
        add(c.origin(h), found->to.front());
        add(c.target(h), found->to.back());
        snapped[e] = *found;
    }
    Targets targets;
    for (const auto& [v, sum] : ends) {
        glm::dvec2 to = sum.first / double(sum.second);
        // What is on the border can only slide along it.
        const glm::dvec2 at = toPixels(mesh.position(v));
        if (at.x == 0 || at.x == mesh.width()) to.x = at.x;
        if (at.y == 0 || at.y == mesh.height()) to.y = at.y;
        targets[ControlPointRef::of(v)] = to;
    }
    for (const auto& [e, found] : snapped) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
        BezierCurve curve = straightCurve(targets[ControlPointRef::of(c.origin(h))],
                                          targets[ControlPointRef::of(c.target(h))]);
        fitInner(found.to, found.t, curve);
        targets[ControlPointRef::of(h)] = curve.p[1];
        targets[ControlPointRef::of(t)] = curve.p[2];
    }
    joinTangents(mesh, targets);
    return targets;
}

}  // namespace

Result<Touched> snapToFeature(PatchMesh& mesh, const Image& photo, std::span<const EdgeId> edges) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<EdgeId> curves;
    for (const EdgeId e : edges)
        if (e.index < c.edgeCapacity() && c.alive(e)) curves.push_back(e);
    std::sort(curves.begin(), curves.end());
    curves.erase(std::unique(curves.begin(), curves.end()), curves.end());
    Touched touched;
    bool found = false;
    // The second time from where the first one led to, with normals that cross the edge.
    for (const double reach : {kSnapReachPx, .25 * kSnapReachPx}) {
        std::vector<PointMove> moves;
        for (const auto& [point, to] : findTargets(mesh, photo, curves, reach)) moves.push_back({point, to});
        if (moves.empty()) continue;
        const DragResult result = movePoints(mesh, moves);
        found = found || result.fraction > 0;
        if (result.fraction > 0) touched = united(touched, result.touched);
    }
    if (!found)
        return failure(ErrorCode::Usage,
                       "the photo has no edge near the selected curves that they could move onto");
    return touched;
}

}  // namespace tessera
