// See blur_tool.h.
#include "app/tools/blur_tool.h"

#include <algorithm>

#include "core/edit/blur_room.h"
#include "core/edit/edge_edits.h"

namespace tessera {

namespace {

// Where the blur ends, in sigmas (blur_profile.h).
constexpr double kReach = 3;
// The handle of a hard feature stays clear of the curve.
constexpr double kHandleGapPx = 10;  // on the screen
constexpr double kEndShare = .25;    // of a curve: where a press means its end alone

BezierCurve curveOf(const PatchMesh& mesh, EdgeId e) {
    return toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
}

double sigmaAt(const EdgeCurve& curve, double t) {
    return (1 - t) * double(curve.blurSigma[0]) + t * double(curve.blurSigma[1]);
}

// The next curve of the feature beyond the target of h, as the halfedge that leaves it; none at its end.
HalfedgeId continued(const PatchMesh& mesh, HalfedgeId h) {
    const HalfedgeMesh& connectivity = mesh.connectivity();
    const VertexId v = connectivity.target(h);
    if (connectivity.onBorder(v)) return {};
    HalfedgeId next;
    int features = 0;
    connectivity.forEachOutgoing(v, [&](HalfedgeId out) {
        if (!mesh.curve(HalfedgeMesh::edge(out)).feature) return;
        ++features;
        if (out != HalfedgeMesh::twin(h)) next = out;
    });
    return features == 2 ? next : HalfedgeId();
}

}  // namespace

std::vector<EdgeId> wholeFeature(const PatchMesh& mesh, EdgeId edge) {
    const HalfedgeId seed = HalfedgeMesh::halfedge(edge);
    if (!mesh.curve(edge).feature) return {edge};
    // Back to its beginning, or once around.
    HalfedgeId first = HalfedgeMesh::twin(seed);
    for (HalfedgeId h = continued(mesh, first); h.valid() && h != HalfedgeMesh::twin(seed);
         h = continued(mesh, h))
        first = h;
    first = HalfedgeMesh::twin(first);
    std::vector<EdgeId> edges{HalfedgeMesh::edge(first)};
    for (HalfedgeId h = continued(mesh, first); h.valid() && h != first; h = continued(mesh, h))
        edges.push_back(HalfedgeMesh::edge(h));
    return edges;
}

std::optional<CurveHit> BlurTool::featureAt(const ToolEvent& event) const {
    const double radius = (kHandleGapPx + kHandleRadiusPx) * event.pxPerScreenPx;
    // A soft feature is taken hold of as far as its handle.
    std::optional<CurveHit> nearest;
    double best = 0;
    const double reach = radius + kReach * kWidestBlurPx;
    for (const PatchId p : session().query().patchesIn({event.point - reach, event.point + reach}))
        for (const HalfedgeId h : mesh().connectivity().sides(p)) {
            const EdgeId e = HalfedgeMesh::edge(h);
            const EdgeCurve& curve = mesh().curve(e);
            if (!curve.feature) continue;
            const CurveFoot foot = nearestOnCurve(curveOf(mesh(), e), event.point);
            const double excess = foot.distance - kReach * sigmaAt(curve, foot.t);
            if (excess > radius || (nearest && excess >= best)) continue;
            nearest = CurveHit{e, foot.t, foot.distance};
            best = excess;
        }
    return nearest;
}

void BlurTool::hovered(const ToolEvent& event) {
    mPxPerScreenPx = event.pxPerScreenPx;
    mHover = featureAt(event);
}

void BlurTool::pressed(const ToolEvent& event) {
    hovered(event);
    mHeld = mHover;
}

void BlurTool::clicked(const ToolEvent&) {
    if (!mHeld) host().say(QObject::tr("Drag away from a feature to make it softer, toward it for sharper."));
    mHeld.reset();
}

void BlurTool::dragStarted(const ToolEvent&) {
    if (!mHeld || !begin(mEdit, QObject::tr("Soften"))) return;
    mEdges = options().wholeFeatures ? wholeFeature(mesh(), mHeld->edge) : std::vector{mHeld->edge};
    mRoom = blurRoom(session().query(), mEdges);
}

void BlurTool::dragged(const ToolEvent& event) {
    if (!mEdit) return;
    const EdgeCurve& curve = mEdit->start().curve(mHeld->edge);
    const double distance = nearestOnCurve(curveOf(mEdit->start(), mHeld->edge), event.point).distance;
    const double change = (distance - mHeld->distance) / kReach;
    const double sigma = std::clamp(sigmaAt(curve, mHeld->t) + change, 0., kWidestBlurPx);
    std::array<double, 2> ends{sigma, sigma};
    if (mEdges.size() == 1 && mHeld->t < kEndShare) ends[1] = double(curve.blurSigma[1]);
    if (mEdges.size() == 1 && mHeld->t > 1 - kEndShare) ends[0] = double(curve.blurSigma[0]);
    report(mEdit->preview([&](PatchMesh& mesh) { return setBlur(mesh, mEdges, ends[0], ends[1], mRoom); }));
    constexpr double kNoticedPx = .1;
    if (sigma > sigmaAt(mesh().curve(mHeld->edge), mHeld->t) + kNoticedPx)
        host().say(QObject::tr("It cannot become softer here: another feature or its own end is too near."));
}

void BlurTool::dropped(const ToolEvent&) {
    if (mEdit) mEdit->commit();
    abandoned();
}

void BlurTool::abandoned() {
    mEdit.reset();
    mHeld.reset();
    mEdges.clear();
    mRoom.clear();
}

ToolOverlay BlurTool::overlay() const {
    ToolOverlay overlay;
    const std::optional<CurveHit>& hit = mHeld ? mHeld : mHover;
    if (!hit) return overlay;
    overlay.hoveredCurve = hit->edge;
    if (mEdit) overlay.curves = mEdges;
    const BezierCurve curve = curveOf(mesh(), hit->edge);
    const glm::dvec2 foot = curve.at(hit->t), along = curve.derivative(hit->t);
    if (along == glm::dvec2(0)) return overlay;
    const glm::dvec2 normal = glm::normalize(glm::dvec2(-along.y, along.x));
    const double reach = kReach * sigmaAt(mesh().curve(hit->edge), hit->t) + kHandleGapPx * mPxPerScreenPx;
    for (const double side : {-1., 1.}) {
        overlay.handles.push_back({.shape = OverlayHandle::Shape::Blur,
                                   .at = foot + side * reach * normal,
                                   .selected = mEdit.has_value(),
                                   .hovered = true});
        overlay.handleLines.push_back({foot, overlay.handles.back().at});
    }
    return overlay;
}

}  // namespace tessera
