// See overlay_painter.h.
#include "ui/overlay_painter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ui/conversions.h"

namespace tessera {

namespace {

// From afar, where lines are close together, they are thinner, so that the picture stays visible between
// them.
const LineStyle kFeatureNear{QColor(255, 214, 92), QColor(20, 14, 0, 190), 1.6, 4.0};
const LineStyle kFeatureFar{QColor(255, 214, 92), QColor(20, 14, 0, 150), 1.1, 2.6};
const LineStyle kEdgeNear{QColor(255, 255, 255, 205), QColor(0, 0, 0, 120), 1.0, 2.6};
const LineStyle kEdgeFar{QColor(255, 255, 255, 130), QColor(0, 0, 0, 70), .8, 2.0};
const LineStyle kHandleStyle{QColor(120, 205, 255), QColor(0, 20, 34, 170), 1.0, 2.6};

// By the median length of the edges in view: lines are drawn near from here on, and edges have a halo from
// there.
constexpr double kNearFromPx = 30;
constexpr double kHaloFromPx = 9;
// Control points of an edge appear where it is this long, so that they never hide what they belong to.
constexpr double kVertexFromPx = 26;
constexpr double kFeatureHandleFromPx = 44;
constexpr double kHandleFromPx = 90;
constexpr double kVertexSizePx = 7;
constexpr double kHandleSizePx = 5.5;
const QColor kMarkOutline(10, 12, 16);
// A curve is drawn as segments of about this length.
constexpr double kSegmentPx = 7;
constexpr double kMaxSegments = 64;
constexpr double kDashPx = 6;
// Round caps close the notches between segments, but cost eight times as much as the lines themselves; where
// there are many lines, they are short and nobody sees notches.
constexpr size_t kMaxRoundCaps = 4000;

constexpr size_t kFeatureClasses = 4;  // for each tint
using FeatureScale = std::array<FeatureShade, kFeatureClasses>;
const QColor kCrisp(255, 214, 92), kWarm(255, 150, 110), kCool(230, 120, 220), kSoft(120, 170, 255);
// In px of blur, from crisp to soft, and in levels of jump, from faint to strong.
const FeatureScale kBlurScale{{{0, kCrisp}, {.6F, kWarm}, {1.2F, kCool}, {2.4F, kSoft}}};
const FeatureScale kJumpScale{{{0, kSoft}, {16 / 255.F, kCool}, {40 / 255.F, kWarm}, {90 / 255.F, kCrisp}}};

size_t classOf(std::span<const FeatureShade> scale, float value) {
    size_t found = 0;
    for (size_t i = 1; i < scale.size(); ++i)
        if (value >= scale[i].from) found = i;
    return found;
}

// The distance in RGB of the colours on both sides, the mean of a few points along the edge. (The opponent
// basis is orthonormal: distances are the same in it.)
float jumpAcross(const PatchMesh& mesh, EdgeId edge) {
    constexpr size_t kPoints = 3;
    const HalfedgeMesh& connectivity = mesh.connectivity();
    std::array<std::array<std::array<float, kPoints>, kMaxChannels>, 2> colours{};
    for (const size_t side : {0, 1}) {
        const HalfedgeId forward = HalfedgeMesh::halfedge(edge);
        const HalfedgeId h = side == 0 ? forward : HalfedgeMesh::twin(forward);
        const PatchId p = connectivity.face(h);
        if (!p.valid()) return 0;
        const auto sides = connectivity.sides(p);
        const auto corner = int(std::find(sides.begin(), sides.end(), h) - sides.begin());
        std::array<float, kPoints> x{}, y{};
        for (size_t i = 0; i < kPoints; ++i) {
            const double along = double(i + 1) / (kPoints + 1), t = side == 0 ? along : 1 - along;
            Barycentric at(0);
            at[corner] = 1 - t;
            at[(corner + 1) % 3] = t;
            const glm::dvec2 place = domainPoint(at);
            x[i] = float(place.x);
            y[i] = float(place.y);
        }
        std::array<float*, kMaxChannels> planes{};
        for (size_t c = 0; c < kMaxChannels; ++c) planes[c] = colours[side][c].data();
        evaluateSplines(mesh.spline(p), mesh.channels(), x.data(), y.data(), kPoints, planes.data());
    }
    float sum = 0;
    for (size_t i = 0; i < kPoints; ++i)
        sum += std::hypot(colours[0][0][i] - colours[1][0][i], colours[0][1][i] - colours[1][1][i],
                          colours[0][2][i] - colours[1][2][i]);
    return sum / kPoints;
}

double length(QPointF p) {
    return std::hypot(p.x(), p.y());
}

// Whether the inner control points leave the chord by less than a lattice step or two.
bool isStraight(const std::array<QPointF, 4>& p) {
    const QPointF chord = p[3] - p[0];
    const double size = length(chord);
    if (size == 0) return false;
    const auto offset = [&](QPointF q) {
        return std::abs(chord.x() * (q.y() - p[0].y()) - chord.y() * (q.x() - p[0].x())) / size;
    };
    return std::max(offset(p[1]), offset(p[2])) < .01;
}

QPointF at(const std::array<QPointF, 4>& p, double t) {
    const double s = 1 - t;
    return p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
}

// Keeps a segment's coordinates within what the rasterizer takes, at deep zoom: false where it misses `clip`.
bool clipSegment(QPointF& a, QPointF& b, const QRectF& clip) {
    const QPointF d = b - a;
    double t0 = 0, t1 = 1;
    const auto cut = [&](double start, double delta, double low, double high) {
        if (delta == 0) return start >= low && start <= high;
        double in = (low - start) / delta, out = (high - start) / delta;
        if (in > out) std::swap(in, out);
        t0 = std::max(t0, in);
        t1 = std::min(t1, out);
        return t0 <= t1;
    };
    if (!cut(a.x(), d.x(), clip.left(), clip.right()) || !cut(a.y(), d.y(), clip.top(), clip.bottom()))
        return false;
    b = a + d * t1;
    a = a + d * t0;
    return true;
}

void appendSegment(std::vector<QLineF>& lines, QPointF a, QPointF b, const QRectF& clip) {
    if (clipSegment(a, b, clip)) lines.emplace_back(a, b);
}

void drawLines(QPainter& painter, const std::vector<QLineF>& lines, const QColor& colour, double width) {
    if (lines.empty()) return;
    const bool round = lines.size() <= kMaxRoundCaps;
    painter.setPen(QPen(colour, width, Qt::SolidLine, round ? Qt::RoundCap : Qt::FlatCap));
    painter.drawLines(lines.data(), int(lines.size()));
}

void drawTwoTone(QPainter& painter, const std::vector<QLineF>& lines, const LineStyle& style,
                 double pixelRatio, bool halo) {
    if (halo) drawLines(painter, lines, style.halo, style.haloPx * pixelRatio);
    drawLines(painter, lines, style.core, style.corePx * pixelRatio);
}

// The length of a curve, near enough to lay dashes by.
double lengthOf(const std::array<QPointF, 4>& p) {
    constexpr int kParts = 8;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) sum += length(at(p, (i + 1.) / kParts) - at(p, double(i) / kParts));
    return sum;
}

// What of a line belongs to dashes, where `along` is how far it begins along an outline of dashes and gaps of
// `dash` each.
void appendDashes(std::vector<QLineF>& dashes, const QLineF& line, double along, double dash) {
    const double size = line.length();
    for (double from = 2 * dash * std::floor(along / (2 * dash)) - along; from < size; from += 2 * dash) {
        const double a = std::max(from, 0.), b = std::min(from + dash, size);
        if (a < b) dashes.emplace_back(line.pointAt(a / size), line.pointAt(b / size));
    }
}

QRectF markAt(QPointF centre, double size) {
    return {centre.x() - size / 2, centre.y() - size / 2, size, size};
}

}  // namespace

std::span<const FeatureShade> featureShades(FeatureTint tint) {
    return tint == FeatureTint::Importance ? kJumpScale : kBlurScale;
}

OverlayPainter::Curve OverlayPainter::curveOf(const PatchMesh& mesh, EdgeId edge) {
    const BezierCurve curve = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(edge)));
    Curve shown;
    double left = curve.p[0].x, right = left, top = curve.p[0].y, bottom = top;
    for (size_t i = 0; i < 4; ++i) {
        shown.p[i] = toPoint(curve.p[i]);
        left = std::min(left, curve.p[i].x);
        right = std::max(right, curve.p[i].x);
        top = std::min(top, curve.p[i].y);
        bottom = std::max(bottom, curve.p[i].y);
    }
    shown.box = QRectF(QPointF(left, top), QPointF(right, bottom));
    shown.alive = true;
    const EdgeCurve& known = mesh.curve(edge);
    shown.feature = known.feature;
    shown.blurPx = .5F * (known.blurSigma[0] + known.blurSigma[1]);
    shown.straight = isStraight(shown.p);
    return shown;
}

OverlayPainter::OverlayPainter(const PatchMesh& mesh) : mCurves(mesh.connectivity().edgeCapacity()) {
    mesh.forEachEdge([&](EdgeId e) { mCurves[e.index] = curveOf(mesh, e); });
}

void OverlayPainter::update(const PatchMesh& mesh, std::span<const EdgeId> edges) {
    for (const EdgeId e : edges) {
        Curve& curve = mCurves[e.index] = curveOf(mesh, e);
        if (mMeasuresJumps && curve.feature) curve.jump = jumpAcross(mesh, e);
    }
}

void OverlayPainter::measureJumps(const PatchMesh& mesh) {
    mMeasuresJumps = true;
    mesh.forEachEdge([&](EdgeId e) {
        if (mCurves[e.index].feature) mCurves[e.index].jump = jumpAcross(mesh, e);
    });
}

std::vector<OverlayPainter::Shown> OverlayPainter::shown(const ViewTransform& view,
                                                         const QRectF& visible) const {
    std::vector<Shown> result;
    const QRectF window(view.toImage(visible.topLeft()), view.toImage(visible.bottomRight()));
    for (const Curve& curve : mCurves)
        if (curve.alive) appendShown(result, curve, view, window);
    return result;
}

void OverlayPainter::appendShown(std::vector<Shown>& result, const Curve& curve, const ViewTransform& view,
                                 const QRectF& window) {
    // Not QRectF::intersects: it takes a box without an area (a straight edge of the border) for empty.
    if (curve.box.left() > window.right() || curve.box.right() < window.left() ||
        curve.box.top() > window.bottom() || curve.box.bottom() < window.top())
        return;
    Shown shown{.p = {},
                .feature = curve.feature,
                .straight = curve.straight,
                .blurPx = curve.blurPx,
                .jump = curve.jump};
    for (size_t i = 0; i < 4; ++i) shown.p[i] = view.toScreen(curve.p[i]);
    shown.sizePx = length(shown.p[3] - shown.p[0]);
    result.push_back(shown);
}

void OverlayPainter::paint(QPainter& painter, const ViewTransform& view, const QRectF& visible,
                           double pixelRatio, const OverlayOptions& options) const {
    if (!options.any()) return;
    const double margin = 2 * kVertexSizePx * pixelRatio;
    const QRectF clip = visible.adjusted(-margin, -margin, margin, margin);
    const std::vector<Shown> edges = shown(view, clip);
    if (edges.empty()) return;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    paintCurves(painter, edges, clip, pixelRatio, options);
    if (options.vertices || options.controlPoints)
        paintControlPoints(painter, edges, clip, pixelRatio, options.controlPoints);
    painter.restore();
}

void OverlayPainter::paintOutline(QPainter& painter, const ViewTransform& view, const QRectF& visible,
                                  double pixelRatio, std::span<const EdgeId> edges,
                                  const LineStyle& style) const {
    const double margin = style.haloPx * pixelRatio;
    const QRectF clip = visible.adjusted(-margin, -margin, margin, margin);
    const QRectF window(view.toImage(clip.topLeft()), view.toImage(clip.bottomRight()));
    std::vector<Shown> found;
    for (const EdgeId e : edges) appendShown(found, mCurves[e.index], view, window);
    std::vector<QLineF> lines;
    for (const Shown& edge : found) appendCurve(lines, edge, clip, pixelRatio);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    drawLines(painter, lines, style.halo, style.haloPx * pixelRatio);
    drawLines(painter, style.dashed ? dashesAlong(edges, view, clip, pixelRatio) : lines, style.core,
              style.corePx * pixelRatio);
    painter.restore();
}

std::vector<QLineF> OverlayPainter::dashesAlong(std::span<const EdgeId> edges, const ViewTransform& view,
                                                const QRectF& clip, double pixelRatio) const {
    const QRectF window(view.toImage(clip.topLeft()), view.toImage(clip.bottomRight()));
    std::vector<QLineF> dashes;
    std::vector<Shown> shown;
    double along = 0;  // image px
    std::optional<QPointF> end;
    for (size_t i = 0; i < edges.size(); ++i) {
        Curve curve = mCurves[edges[i].index];
        const auto meets = [](QPointF point, const Curve& other) {
            return point == other.p[0] || point == other.p[3];
        };
        // It goes on from where the one before has ended; a first one toward the one that follows.
        const bool goesOn = end && meets(*end, curve);
        const bool turned = goesOn ? *end != curve.p[0]
                                   : i + 1 < edges.size() && !meets(curve.p[3], mCurves[edges[i + 1].index]);
        if (turned) std::reverse(curve.p.begin(), curve.p.end());
        if (!goesOn) along = 0;
        shown.clear();
        appendShown(shown, curve, view, window);
        if (!shown.empty()) appendDashedCurve(dashes, shown.front(), along * view.scale(), clip, pixelRatio);
        along += lengthOf(curve.p);
        end = curve.p[3];
    }
    return dashes;
}

void OverlayPainter::appendDashedCurve(std::vector<QLineF>& dashes, const Shown& edge, double along,
                                       const QRectF& clip, double pixelRatio) {
    forEachSegment(edge, pixelRatio, [&](QPointF from, QPointF to) {
        QPointF a = from, b = to;
        if (clipSegment(a, b, clip))
            appendDashes(dashes, QLineF(a, b), along + length(a - from), kDashPx * pixelRatio);
        along += length(to - from);
    });
}

void OverlayPainter::paintCurves(QPainter& painter, const std::vector<Shown>& edges, const QRectF& clip,
                                 double pixelRatio, const OverlayOptions& options) {
    std::vector<QLineF> plain;
    std::array<std::vector<QLineF>, kFeatureClasses> features;
    const std::span<const FeatureShade> shades = featureShades(options.tint);
    const auto classOfFeature = [&](const Shown& edge) {
        switch (options.tint) {
            case FeatureTint::Blur:
                return classOf(shades, edge.blurPx);
            case FeatureTint::Importance:
                return classOf(shades, edge.jump);
            case FeatureTint::Plain:
                break;
        }
        return size_t(0);
    };
    std::vector<double> sizes;
    for (const Shown& edge : edges) {
        sizes.push_back(edge.sizePx / pixelRatio);
        if (edge.feature && options.features)
            appendCurve(features[classOfFeature(edge)], edge, clip, pixelRatio);
        else if (options.edges)
            appendCurve(plain, edge, clip, pixelRatio);
    }
    const auto median = sizes.begin() + std::ptrdiff_t(sizes.size() / 2);
    std::nth_element(sizes.begin(), median, sizes.end());
    const bool near = *median >= kNearFromPx;
    drawTwoTone(painter, plain, near ? kEdgeNear : kEdgeFar, pixelRatio, *median >= kHaloFromPx);
    for (size_t i = 0; i < features.size(); ++i) {
        LineStyle style = near ? kFeatureNear : kFeatureFar;
        style.core = shades[i].colour;
        drawTwoTone(painter, features[i], style, pixelRatio, true);
    }
}

template <class Visit>
void OverlayPainter::forEachSegment(const Shown& edge, double pixelRatio, Visit&& visit) {
    const auto& p = edge.p;
    const double reach = length(p[1] - p[0]) + length(p[2] - p[1]) + length(p[3] - p[2]);
    const int n = edge.straight ? 1 : int(std::clamp(reach / (kSegmentPx * pixelRatio), 2.0, kMaxSegments));
    QPointF last = p[0];
    for (int i = 1; i <= n; ++i) {
        const QPointF next = i == n ? p[3] : at(p, double(i) / n);
        visit(last, next);
        last = next;
    }
}

void OverlayPainter::appendCurve(std::vector<QLineF>& lines, const Shown& edge, const QRectF& clip,
                                 double pixelRatio) {
    forEachSegment(edge, pixelRatio, [&](QPointF a, QPointF b) { appendSegment(lines, a, b, clip); });
}

void OverlayPainter::paintControlPoints(QPainter& painter, const std::vector<Shown>& edges,
                                        const QRectF& clip, double pixelRatio, bool withHandles) {
    std::vector<QLineF> lines;
    std::vector<QPointF> handles, vertices;
    for (const Shown& edge : edges) {
        for (const auto& [end, inner] : {std::pair{edge.p[0], edge.p[1]}, std::pair{edge.p[3], edge.p[2]}}) {
            if (edge.sizePx >= kVertexFromPx * pixelRatio && clip.contains(end)) vertices.push_back(end);
            if (!withHandles ||
                edge.sizePx < (edge.feature ? kFeatureHandleFromPx : kHandleFromPx) * pixelRatio)
                continue;
            appendSegment(lines, end, inner, clip);
            if (clip.contains(inner)) handles.push_back(inner);
        }
    }
    // Each vertex once, though every edge around it names it.
    std::sort(vertices.begin(), vertices.end(),
              [](QPointF a, QPointF b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

    drawTwoTone(painter, lines, kHandleStyle, pixelRatio, true);
    painter.setPen(QPen(kMarkOutline, 1.4 * pixelRatio));
    painter.setBrush(kHandleStyle.core);
    for (const QPointF handle : handles) painter.drawEllipse(markAt(handle, kHandleSizePx * pixelRatio));
    painter.setBrush(Qt::white);
    for (const QPointF vertex : vertices) painter.drawRect(markAt(vertex, kVertexSizePx * pixelRatio));
}

}  // namespace tessera
