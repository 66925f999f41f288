// Draws what lies over the picture: features, patch edges and control points, of constant size on the screen
// and legible on any colour.
#pragma once

#include <QPainter>
#include <array>
#include <span>
#include <vector>

#include "core/mesh/patch_mesh.h"
#include "ui/view_transform.h"

namespace tessera {

// What the colour of a feature says: nothing, how soft it is, or how far colours jump across it.
enum class FeatureTint { Plain, Blur, Importance };

// The colour of features from one value on up to the next: of their blur, px, or of the jump, 0..1.
struct FeatureShade {
    float from;
    QColor colour;
};
// By ascending value, the first from 0 on; for a tint that says something.
std::span<const FeatureShade> featureShades(FeatureTint tint);

struct OverlayOptions {
    bool features = false;
    FeatureTint tint = FeatureTint::Plain;
    bool edges = false;
    bool vertices = false;
    bool controlPoints = false;  // vertices and handles
    bool centres = false;        // of the splines; see centres_painter.h

    // Whether there is anything for the painter of the curves.
    bool any() const { return features || edges || vertices || controlPoints; }
    bool operator==(const OverlayOptions&) const = default;
};

// Two tones: the halo parts the line from a light ground, the core from a dark one.
struct LineStyle {
    QColor core;
    QColor halo;
    double corePx;
    double haloPx;
    bool dashed = false;  // the core alone, of outlines
};

// The curves of one state of a mesh in flat arrays, made once, so that a frame costs a pass over the boxes
// and the drawing of what is in view.
class OverlayPainter {
  public:
    OverlayPainter() = default;
    explicit OverlayPainter(const PatchMesh& mesh);

    // Takes over these curves of a mesh of the same connectivity.
    void update(const PatchMesh& mesh, std::span<const EdgeId> edges);
    // Looks at the jumps of colour too, as FeatureTint::Importance needs, from now on; `mesh` is the present
    // one.
    void measureJumps(const PatchMesh& mesh);
    bool measuresJumps() const { return mMeasuresJumps; }

    // Paints in device pixels: the painter's transform takes them as they are. `pixelRatio` is how many of
    // them a line of "one pixel" is wide; `visible` is the part of the screen to paint.
    void paint(QPainter& painter, const ViewTransform& view, const QRectF& visible, double pixelRatio,
               const OverlayOptions& options) const;

    // Paints these edges alone, as the outline of what is selected. Dashes run on from an edge to the next
    // where that begins or ends there.
    void paintOutline(QPainter& painter, const ViewTransform& view, const QRectF& visible, double pixelRatio,
                      std::span<const EdgeId> edges, const LineStyle& style) const;

  private:
    // One edge's cubic, in image pixels.
    struct Curve {
        std::array<QPointF, 4> p;
        QRectF box;
        bool alive = false;
        bool feature = false;
        bool straight = false;
        float blurPx = 0;  // mean of both ends
        float jump = 0;    // of colour across a feature, as a distance in RGB, 0..1; where it is measured
    };
    // An edge in view, on the screen.
    struct Shown {
        std::array<QPointF, 4> p;
        bool feature = false;
        bool straight = false;
        float blurPx = 0;
        float jump = 0;
        double sizePx = 0;
    };

    static Curve curveOf(const PatchMesh& mesh, EdgeId edge);
    static void appendShown(std::vector<Shown>& result, const Curve& curve, const ViewTransform& view,
                            const QRectF& window);
    std::vector<Shown> shown(const ViewTransform& view, const QRectF& visible) const;
    static void paintCurves(QPainter& painter, const std::vector<Shown>& edges, const QRectF& clip,
                            double pixelRatio, const OverlayOptions& options);
    static void paintControlPoints(QPainter& painter, const std::vector<Shown>& edges, const QRectF& clip,
                                   double pixelRatio, bool withHandles);
    std::vector<QLineF> dashesAlong(std::span<const EdgeId> edges, const ViewTransform& view,
                                    const QRectF& clip, double pixelRatio) const;
    // `along`: where it begins along its outline, in screen px.
    static void appendDashedCurve(std::vector<QLineF>& dashes, const Shown& edge, double along,
                                  const QRectF& clip, double pixelRatio);
    // Flattens an edge.
    template <class Visit>
    static void forEachSegment(const Shown& edge, double pixelRatio, Visit&& visit);
    // Its segments; one that misses `clip` is left out.
    static void appendCurve(std::vector<QLineF>& lines, const Shown& edge, const QRectF& clip,
                            double pixelRatio);

    std::vector<Curve> mCurves;  // by edge id
    bool mMeasuresJumps = false;
};

}  // namespace tessera
