// See edge_edits.h.
#include "core/edit/edge_edits.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/check.h"
#include "core/edit/colour_samples.h"

namespace tessera {

namespace {

// The halfedges of edges that follow each other end to end in their order; empty where they do not.
std::vector<HalfedgeId> pathOf(const PatchMesh& mesh, std::span<const EdgeId> edges) {
    const HalfedgeMesh& c = mesh.connectivity();
    for (const bool turned : {false, true}) {
        std::vector<HalfedgeId> path;
        for (const EdgeId e : edges) {
            HalfedgeId h = HalfedgeMesh::halfedge(e);
            if (path.empty() ? turned : c.origin(h) != c.target(path.back())) h = HalfedgeMesh::twin(h);
            if (!path.empty() && c.origin(h) != c.target(path.back())) break;
            path.push_back(h);
        }
        if (path.size() == edges.size()) return path;
    }
    return {};
}

std::vector<PatchId> patchesBeside(const PatchMesh& mesh, std::span<const EdgeId> edges) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<PatchId> patches;
    for (const EdgeId e : edges)
        for (const HalfedgeId h : {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))})
            if (c.face(h).valid()) patches.push_back(c.face(h));
    return patches;
}

Result<void> checkAlive(const PatchMesh& mesh, std::span<const EdgeId> edges) {
    for (const EdgeId e : edges)
        if (e.index >= mesh.connectivity().edgeCapacity() || !mesh.connectivity().alive(e))
            return failure(ErrorCode::Usage, "one of these curves is not there any more; select it again");
    return {};
}

// Whether colours differ by a level or more anywhere along an edge.
bool hasJump(const PatchMesh& mesh, EdgeId e) {
    constexpr int kSamples = 9;
    constexpr double kLevel = 1.0 / 255;
    const HalfedgeMesh& c = mesh.connectivity();
    const HalfedgeId sides[] = {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))};
    std::vector<ColourSample> samples[2];
    for (size_t k = 0; k < 2; ++k) {
        const auto all = c.sides(c.face(sides[k]));
        const int side = int(std::find(all.begin(), all.end(), sides[k]) - all.begin());
        std::vector<Barycentric> points;
        for (int i = 0; i < kSamples; ++i) {
            const double t = double(i) / (kSamples - 1), along = k == 0 ? t : 1 - t;
            Barycentric b(0);
            b[side] = 1 - along;
            b[(side + 1) % 3] = along;
            points.push_back(b);
        }
        samples[k] = sampleColours(mesh, c.face(sides[k]), DomainPoints(points));
    }
    for (size_t i = 0; i < size_t(kSamples); ++i) {
        const glm::dvec3 d = samples[0][i].srgb - samples[1][i].srgb;
        const double opacity = samples[0][i].alpha - samples[1][i].alpha;
        if (std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z), std::abs(opacity)}) >= kLevel) return true;
    }
    return false;
}

}  // namespace

Result<Touched> setBlur(PatchMesh& mesh, std::span<const EdgeId> edges, double sigmaStart, double sigmaEnd,
                        std::span<const std::array<double, 2>> room) {
    TESSERA_CHECK(room.empty() || room.size() == edges.size());
    if (const auto sound = checkAlive(mesh, edges); !sound) return tl::unexpected<Error>(sound.error());
    const auto inRange = [](double sigma) { return sigma >= 0 && sigma <= kWidestBlurPx; };
    if (!inRange(sigmaStart) || !inRange(sigmaEnd))
        return failure(ErrorCode::Usage, "a blur is from 0 to " + std::to_string(int(kWidestBlurPx)) +
                                             " px wide; choose one in this range");
    for (const EdgeId e : edges)
        if (!mesh.curve(e).feature)
            return failure(ErrorCode::Usage, "only features have a blur; mark the curve as a feature first");
    const std::vector<HalfedgeId> path = pathOf(mesh, edges);
    if (path.empty() && !edges.empty() && sigmaStart != sigmaEnd)
        return failure(
            ErrorCode::Usage,
            "these curves do not follow each other; give both ends the same blur, or select a path");
    std::vector<double> arc{0};
    for (const HalfedgeId h : path) arc.push_back(arc.back() + toPixels(mesh.controlPoints(h)).length());
    const auto sigmaAt = [&](size_t i) {
        return float(sigmaStart + (arc.back() > 0 ? arc[i] / arc.back() : 0) * (sigmaEnd - sigmaStart));
    };
    for (size_t i = 0; i < edges.size(); ++i) {
        EdgeCurve curve = mesh.curve(edges[i]);
        std::array<float, 2> sigma{float(sigmaStart), float(sigmaEnd)};
        if (!path.empty()) {
            const bool along = HalfedgeMesh::halfedge(edges[i]) == path[i];
            sigma = {sigmaAt(along ? i : i + 1), sigmaAt(along ? i + 1 : i)};
        }
        if (!room.empty())
            for (size_t end = 0; end < 2; ++end)
                sigma[end] = std::min(sigma[end], std::max(curve.blurSigma[end], float(room[i][end])));
        curve.blurSigma = sigma;
        mesh.setCurve(edges[i], curve);
    }
    return touchedOf({}, {edges.begin(), edges.end()}, patchesBeside(mesh, edges));
}

Result<Touched> setFeature(PatchMesh& mesh, std::span<const EdgeId> edges, bool feature) {
    if (const auto sound = checkAlive(mesh, edges); !sound) return tl::unexpected<Error>(sound.error());
    for (const EdgeId e : edges)
        if (mesh.connectivity().onBorder(e))
            return failure(ErrorCode::Usage, "the picture's border is no feature; choose a curve inside it");
    std::vector<EdgeId> changed;
    for (const EdgeId e : edges) {
        EdgeCurve curve = mesh.curve(e);
        if (curve.feature == feature) continue;
        curve.feature = feature;
        curve.blurSigma = {};
        curve.colourBreak = !feature && hasJump(mesh, e);
        mesh.setCurve(e, curve);
        changed.push_back(e);
    }
    if (!feature && !changed.empty()) {
        auto joins = mesh.smoothJoins();
        std::erase_if(joins, [&](const SmoothJoin& join) {
            return !mesh.curve(join.first).feature || !mesh.curve(join.second).feature;
        });
        mesh.setSmoothJoins(std::move(joins));
    }
    return touchedOf({}, changed, patchesBeside(mesh, changed));
}

}  // namespace tessera
