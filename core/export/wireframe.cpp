// See wireframe.h.
#include "core/export/wireframe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/base/check.h"

namespace tessera {

namespace {

const cv::Scalar kFeatureColour(.85, .1, .1), kEdgeColour(.12, .2, .5), kVertexColour(0, 0, 0);
constexpr int kShift = 4;  // OpenCV's fixed-point coordinates: 1/16 pixel

// Lines over a pale background, in RGB.
class Drawing {
  public:
    // Of the part of the picture that begins at `origin` and has `size` pixels.
    Drawing(glm::ivec2 origin, glm::ivec2 size, int scale, const Image& background)
        : mOrigin(origin),
          mScale(scale),
          mCanvas(size.y * scale, size.x * scale, CV_8UC3, cv::Scalar::all(255)) {
        if (background.empty()) return;
        constexpr float kPale = .45F;
        for (int y = 0; y < mCanvas.rows; ++y)
            for (int x = 0; x < mCanvas.cols; ++x)
                for (int c = 0; c < 3; ++c) {
                    const float value =
                        std::clamp(background.at(origin.x + x / scale, origin.y + y / scale, c), 0.F, 1.F);
                    mCanvas.at<cv::Vec3b>(y, x)[c] = uint8_t(std::lround(255 * (1 - kPale * (1 - value))));
                }
    }

    void line(std::span<const glm::dvec2> points, const cv::Scalar& colour, int thickness = 1) {
        std::vector<cv::Point> fixed;
        for (const glm::dvec2& p : points) fixed.push_back(toFixed(p));
        cv::polylines(mCanvas, fixed, false, colour * 255, thickness, cv::LINE_AA, kShift);
    }
    void curve(const BezierCurve& curve, const cv::Scalar& colour, int thickness) {
        constexpr int kSteps = 16;
        std::vector<glm::dvec2> points;
        for (int i = 0; i <= kSteps; ++i) points.push_back(curve.at(double(i) / kSteps));
        line(points, colour, thickness);
    }
    void dot(glm::dvec2 at, double radiusPx, const cv::Scalar& colour) {
        cv::circle(mCanvas, toFixed(at), int(radiusPx * (1 << kShift)), colour * 255, cv::FILLED, cv::LINE_AA,
                   kShift);
    }
    Image image() const {
        Image result(mCanvas.cols, mCanvas.rows, 3);
        for (int y = 0; y < mCanvas.rows; ++y)
            for (int x = 0; x < mCanvas.cols; ++x)
                for (int c = 0; c < 3; ++c) result.at(x, y, c) = float(mCanvas.at<cv::Vec3b>(y, x)[c]) / 255;
        return result;
    }

  private:
    cv::Point toFixed(glm::dvec2 p) const {
        const double unit = mScale * (1 << kShift),
                     half = (1 << kShift) / 2.0;  // OpenCV's pixel centres are whole
        return {int(std::lround((p.x - mOrigin.x) * unit - half)),
                int(std::lround((p.y - mOrigin.y) * unit - half))};
    }
    glm::ivec2 mOrigin;
    int mScale;
    cv::Mat mCanvas;
};

}  // namespace

Image drawFeatures(const std::vector<PixelChain>& chains, int width, int height, int scale,
                   const Image& background) {
    Drawing drawing({0, 0}, {width, height}, scale, background);
    for (const PixelChain& chain : chains) {
        std::vector<glm::dvec2> points;
        for (const glm::ivec2 p : chain.pixels) points.push_back(glm::dvec2(p) + .5);
        if (chain.closed) points.push_back(points.front());
        drawing.line(points, kFeatureColour, std::max(1, scale / 2));
    }
    return drawing.image();
}

Image drawFeatures(const FeatureNetwork& network, int scale, const Image& background) {
    Drawing drawing({0, 0}, {network.width, network.height}, scale, background);
    for (const FeatureSegment& segment : network.segments)
        drawing.curve(curveOf(network, segment), kFeatureColour, std::max(1, scale / 2));
    for (const FeatureNode& node : network.nodes)
        drawing.dot(toPixels(node.position), .6 * scale, kVertexColour);
    return drawing.image();
}

Image drawInitialMesh(const ChannelMeshes& meshes, int windowPx, int scale, const Image& background) {
    const glm::ivec2 size(std::min(windowPx, meshes.width), std::min(windowPx, meshes.height));
    const glm::ivec2 origin((meshes.width - size.x) / 2, (meshes.height - size.y) / 2);
    Drawing drawing(origin, size, scale, background);
    const auto inWindow = [&](glm::dvec2 p) {
        return p.x >= origin.x - 1 && p.y >= origin.y - 1 && p.x <= origin.x + size.x + 1 &&
               p.y <= origin.y + size.y + 1;
    };
    for (const bool features : {false, true})
        for (uint32_t e = 0; e < meshes.mesh.edgeCapacity(); ++e) {
            const HalfedgeId h = HalfedgeMesh::halfedge(EdgeId(e));
            if (meshes.isFeature(EdgeId(e)) != features) continue;
            const glm::dvec2 ends[] = {toPixels(meshes.positions[meshes.mesh.origin(h).index]),
                                       toPixels(meshes.positions[meshes.mesh.target(h).index])};
            if (!inWindow(ends[0])) continue;
            drawing.line(ends, features ? kFeatureColour : kEdgeColour,
                         features ? std::max(1, scale / 4) : 1);
        }
    return drawing.image();
}

Image drawPatches(const PatchMesh& mesh, Outline outline, int scale, const Image& background) {
    Drawing drawing({0, 0}, {mesh.width(), mesh.height()}, scale, background);
    for (const bool features : {false, true})
        mesh.forEachEdge([&](EdgeId e) {
            if (mesh.curve(e).feature != features) return;
            const BezierCurve curve = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
            const cv::Scalar& colour = features ? kFeatureColour : kEdgeColour;
            const int thickness = features ? std::max(1, scale / 2) : 1;
            if (outline == Outline::Curves)
                drawing.curve(curve, colour, thickness);
            else
                drawing.line(std::array{curve.at(0), curve.at(1)}, colour, thickness);
        });
    mesh.forEachVertex(
        [&](VertexId v) { drawing.dot(toPixels(mesh.position(v)), .6 * scale, kVertexColour); });
    return drawing.image();
}

Image residual(const Image& a, const Image& b, double gain) {
    TESSERA_CHECK(a.width() == b.width() && a.height() == b.height() && a.channels() == b.channels());
    Image result(a.width(), a.height(), 3);
    for (int c = 0; c < 3; ++c)
        for (size_t i = 0; i < a.planeSize(); ++i)
            result.plane(c)[i] =
                float(std::clamp(.5 + gain * double(a.plane(c)[i] - b.plane(c)[i]), 0.0, 1.0));
    return result;
}

}  // namespace tessera
