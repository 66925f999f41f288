// See blur_room.h.
#include "core/edit/blur_room.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

#include "core/mesh/blur_profile.h"

namespace tessera {

namespace {

constexpr double kFirstReachPx = 8;
constexpr double kWayShare = 3, kWayPx = 2;

BezierCurve curveOf(const PatchMesh& mesh, EdgeId e) {
    return toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
}

// How far it is from a point of a feature to others along features, px.
class Ways {
  public:
    // Looks no farther than `longest`.
    Ways(const PatchMesh& mesh, EdgeId from, double t, double longest) : mMesh(mesh) {
        const HalfedgeMesh& c = mesh.connectivity();
        using Reached = std::pair<double, uint32_t>;
        std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
        const HalfedgeId start = HalfedgeMesh::halfedge(from);
        queue.emplace(curveOf(mesh, from).part(0, t).length(), c.origin(start).index);
        queue.emplace(curveOf(mesh, from).part(t, 1).length(), c.target(start).index);
        while (!queue.empty()) {
            const double way = queue.top().first;
            const VertexId v(queue.top().second);
            queue.pop();
            if (way > longest || !mByVertex.try_emplace(v.index, way).second) continue;
            int features = 0;
            c.forEachOutgoing(v, [&](HalfedgeId h) {
                const EdgeId e = HalfedgeMesh::edge(h);
                if (!mesh.curve(e).feature) return;
                ++features;
                queue.emplace(way + curveOf(mesh, e).length(), c.target(h).index);
            });
            if (features > 2 || (features == 1 && !c.onBorder(v))) mToEnd = std::min(mToEnd, way);
        }
    }

    // To the point at t of a feature.
    double to(EdgeId e, double t) const {
        const HalfedgeMesh& c = mMesh.connectivity();
        const BezierCurve curve = curveOf(mMesh, e);
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        return std::min(toVertex(c.origin(h)) + curve.part(0, t).length(),
                        toVertex(c.target(h)) + curve.part(t, 1).length());
    }

    // To the nearest tip or junction, toward which a blur fades out.
    double toEnd() const { return mToEnd; }

  private:
    double toVertex(VertexId v) const {
        const auto found = mByVertex.find(v.index);
        return found == mByVertex.end() ? kFar : found->second;
    }

    static constexpr double kFar = std::numeric_limits<double>::infinity();
    const PatchMesh& mMesh;
    std::unordered_map<uint32_t, double> mByVertex;
    double mToEnd = kFar;
};

// The distance from the point at t of a feature to the next feature, where that is within `reach`.
double distanceToNext(const PatchQuery& query, EdgeId from, double t, const Ways& ways, double reach) {
    const PatchMesh& mesh = query.mesh();
    const glm::dvec2 at = curveOf(mesh, from).at(t);
    double nearest = std::numeric_limits<double>::infinity();
    for (const PatchId p : query.patchesIn({at - reach, at + reach}))
        for (const HalfedgeId side : mesh.connectivity().sides(p)) {
            const EdgeId e = HalfedgeMesh::edge(side);
            if (e == from || !mesh.curve(e).feature) continue;
            const CurveFoot foot = nearestOnCurve(curveOf(mesh, e), at);
            if (foot.distance >= std::min(nearest, reach)) continue;
            if (ways.to(e, foot.t) > kWayShare * foot.distance + kWayPx) nearest = foot.distance;
        }
    return nearest;
}

double roomAt(const PatchQuery& query, EdgeId feature, double t, bool withEnds) {
    for (double reach = kFirstReachPx; reach < 2 * kBlurReach * kWidestBlurPx; reach *= 2) {
        const Ways ways(query.mesh(), feature, t, kWayShare * reach + kWayPx);
        double room = distanceToNext(query, feature, t, ways, reach) / kBlurReach;
        if (withEnds) room = std::min(room, ways.toEnd() / kBlurFade);
        // What lies farther leaves more.
        if (room <= reach / kBlurReach) return std::min(room, kWidestBlurPx);
    }
    return kWidestBlurPx;
}

}  // namespace

std::vector<std::array<double, 2>> blurRoom(const PatchQuery& query, std::span<const EdgeId> features) {
    const HalfedgeMesh& c = query.mesh().connectivity();
    // By vertex, so that the blur of curves that follow each other stays continuous. The ends themselves are
    // at no distance from an end: it counts from the middles of curves.
    std::unordered_map<uint32_t, double> room;
    for (const EdgeId e : features) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const double between = roomAt(query, e, .5, true);
        for (const auto& [v, t] : {std::pair(c.origin(h), 0.), std::pair(c.target(h), 1.)}) {
            const auto [entry, isNew] = room.try_emplace(v.index, 0);
            if (isNew) entry->second = roomAt(query, e, t, false);
            entry->second = std::min(entry->second, between);
        }
    }
    std::vector<std::array<double, 2>> byFeature;
    for (const EdgeId e : features) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        byFeature.push_back({room.at(c.origin(h).index), room.at(c.target(h).index)});
    }
    return byFeature;
}

}  // namespace tessera
