// See cli_bench_features.h.
#include "app/cli_bench_features.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <limits>

#include "core/image/image_compare.h"
#include "core/image/reference_edges.h"
#include "core/mesh/bezier.h"

namespace tessera::cli {

namespace {

// Calls visit(x, y) for the pixels of the picture in the box.
template <class Visit>
void forEachPixel(const Image& picture, glm::ivec2 lowest, glm::ivec2 highest, Visit&& visit) {
    for (int y = std::max(0, lowest.y); y <= std::min(picture.height() - 1, highest.y); ++y)
        for (int x = std::max(0, lowest.x); x <= std::min(picture.width() - 1, highest.x); ++x) visit(x, y);
}

size_t indexOf(const Image& picture, int x, int y) {
    return size_t(y) * size_t(picture.width()) + size_t(x);
}

// The reference length that each pixel stands for: half of each step that begins or ends at it.
std::vector<double> lengthByPixel(const Image& picture, const std::vector<EdgeChain>& chains) {
    std::vector<double> length(picture.planeSize());
    for (const EdgeChain& chain : chains)
        for (size_t i = 1; i < chain.size(); ++i) {
            const double half = .5 * lengthPx({chain[i - 1], chain[i]});
            for (const glm::ivec2 p : {chain[i - 1], chain[i]}) length[indexOf(picture, p.x, p.y)] += half;
        }
    return length;
}

// Marks the pixels of `wanted` (those above 0) whose centres are within kRecallReachPx of the curve.
void markNear(const Image& picture, const BezierCurve& curve, const std::vector<double>& wanted,
              std::vector<uint8_t>& near) {
    glm::dvec2 lowest = curve.p[0], highest = curve.p[0];
    for (const glm::dvec2& p : curve.p) {
        lowest = glm::min(lowest, p);
        highest = glm::max(highest, p);
    }
    forEachPixel(picture, glm::ivec2(glm::floor(lowest - kRecallReachPx - 1.)),
                 glm::ivec2(glm::ceil(highest + kRecallReachPx)), [&](int x, int y) {
                     const size_t i = indexOf(picture, x, y);
                     if (wanted[i] > 0 && near[i] == 0)
                         near[i] = nearestOnCurve(curve, {x + .5, y + .5}).distance <= kRecallReachPx;
                 });
}

std::vector<uint8_t> pixelsAround(const Image& picture, const std::vector<EdgeChain>& chains) {
    std::vector<uint8_t> around(picture.planeSize());
    for (const EdgeChain& chain : chains)
        for (const glm::ivec2 p : chain)
            forEachPixel(picture, p - kNearEdgePx, p + kNearEdgePx, [&](int x, int y) {
                const int dx = x - p.x, dy = y - p.y;
                if (dx * dx + dy * dy <= kNearEdgePx * kNearEdgePx) around[indexOf(picture, x, y)] = 1;
            });
    return around;
}

double edgeErrorRatio(const Image& picture, const Image& rendering, const std::vector<EdgeChain>& chains) {
    const std::vector<uint8_t> around = pixelsAround(picture, chains);
    const std::vector<uint8_t> a = rgb8OverWhite(picture), b = rgb8OverWhite(rendering);
    double all = 0, near = 0, nearCount = 0;
    for (size_t i = 0; i < around.size(); ++i) {
        double difference = 0;
        for (size_t c = 0; c < 3; ++c) difference += std::abs(int(a[3 * i + c]) - int(b[3 * i + c]));
        all += difference;
        if (around[i] == 0) continue;
        near += difference;
        ++nearCount;
    }
    if (nearCount == 0 || all == 0) return std::numeric_limits<double>::quiet_NaN();
    return near / nearCount / (all / double(around.size()));
}

struct Recall {
    double referencePx = 0;
    double share = std::numeric_limits<double>::quiet_NaN();
};

Recall recallOf(const Image& picture, const std::vector<EdgeChain>& chains,
                const std::vector<BezierCurve>& features) {
    const std::vector<double> length = lengthByPixel(picture, chains);
    std::vector<uint8_t> near(picture.planeSize());
    for (const BezierCurve& curve : features) markNear(picture, curve, length, near);
    Recall recall;
    double found = 0;
    for (size_t i = 0; i < length.size(); ++i) {
        recall.referencePx += length[i];
        if (near[i] != 0) found += length[i];
    }
    if (recall.referencePx > 0) recall.share = found / recall.referencePx;
    return recall;
}

}  // namespace

Json measureFeatures(const Image& picture, const Image& rendering, const PatchMesh& mesh) {
    std::vector<BezierCurve> features;
    double cut = 0;
    mesh.forEachEdge([&](EdgeId e) {
        if (!mesh.curve(e).feature) return;
        features.push_back(toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e))));
        cut += features.back().length();
    });
    const auto outlines =
        referenceEdges(picture, kOutlineSigmaPx, kReferenceLow, kReferenceHigh, kReferenceMinPixels);
    const auto detail = referenceEdges(picture, 0, kReferenceLow, kReferenceHigh, kReferenceMinPixels);
    const Recall ofOutlines = recallOf(picture, outlines, features),
                 ofDetail = recallOf(picture, detail, features);
    Json json;
    json["reference_px"] = ofOutlines.referencePx;
    json["recall"] = ofOutlines.share;
    json["detail_px"] = ofDetail.referencePx;
    json["detail_recall"] = ofDetail.share;
    json["cut_px"] = cut;
    json["feature_share"] = double(features.size()) / double(mesh.connectivity().edgeCount());
    json["edge_error_ratio"] = edgeErrorRatio(picture, rendering, outlines);
    return json;
}

}  // namespace tessera::cli
