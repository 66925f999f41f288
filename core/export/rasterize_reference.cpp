// The renderer of the paper's section 5, as it is written there: the reference for the fast one (see
// rasterize.h).
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/base/check.h"
#include "core/export/rasterize.h"
#include "core/mesh/edge_blur.h"

namespace tessera {

namespace {

// A piece of a patch in output pixels, and the patch's parameters at the piece's corners.
struct Piece {
    BezierTriangle shape;
    std::array<Barycentric, 3> corners;
};

struct Target {
    const View& view;
    std::vector<PixelOwner>& owners;
};

// Vertices of a vectorized picture often lie on pixel centres, which several patches then share. As with the
// fast path's edge rule, a centre on a side belongs to the patch right of it, on a level side or a vertex to
// that just below.
constexpr glm::dvec2 kTieBreak(1e-10, 1e-7);

// The second stage: pixel centres in the triangle of the piece's corners, bounds included. Where two pieces
// meet in a pixel centre the first one keeps it.
void fillTriangle(const Piece& piece, PatchId patch, Target& target) {
    const glm::dvec2 a = piece.shape.corner(0), b = piece.shape.corner(1), c = piece.shape.corner(2);
    const double area = cross(b - a, c - a);
    if (area <= 0) return;
    const glm::dvec2 lo = glm::min(a, glm::min(b, c)), hi = glm::max(a, glm::max(b, c));
    const int x0 = std::max(0, int(std::ceil(lo.x - .5))),
              x1 = std::min(target.view.width - 1, int(std::floor(hi.x - .5)));
    const int y0 = std::max(0, int(std::ceil(lo.y - .5))),
              y1 = std::min(target.view.height - 1, int(std::floor(hi.y - .5)));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const glm::dvec2 p = glm::dvec2(x + .5, y + .5) + kTieBreak;
            const Barycentric in(cross(b - p, c - p) / area, cross(c - p, a - p) / area,
                                 cross(a - p, b - p) / area);
            if (in.x < 0 || in.y < 0 || in.z < 0) continue;
            PixelOwner& owner = target.owners[size_t(y) * size_t(target.view.width) + size_t(x)];
            if (owner.patch.valid()) continue;
            const Barycentric at =
                in.x * piece.corners[0] + in.y * piece.corners[1] + in.z * piece.corners[2];
            owner = {patch, float(at.y), float(at.z)};
        }
}

// Section 5 asks for pieces smaller than a pixel. Their chords leave cracks where neighbours are cut to
// different depths, a few pixel centres in ten thousand on a photograph; at a quarter of a pixel, a sixteenth
// of that.
constexpr double kPieceSize = .25;

// The first stage: down to pieces whose bounding box (that of the control points, which holds the piece) is
// smaller than kPieceSize output pixels.
void subdivide(const Piece& piece, PatchId patch, Target& target) {
    glm::dvec2 lo = piece.shape.p[0], hi = lo;
    for (const glm::dvec2& p : piece.shape.p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    if (hi.x < 0 || hi.y < 0 || lo.x > target.view.width || lo.y > target.view.height) return;
    if (hi.x - lo.x < kPieceSize && hi.y - lo.y < kPieceSize) return fillTriangle(piece, patch, target);
    const auto children = subdivide4(piece.shape);
    const auto& [a, b, c] = piece.corners;
    const Barycentric i = .5 * (a + b), j = .5 * (b + c), k = .5 * (c + a);
    subdivide({children[0], {a, i, k}}, patch, target);
    subdivide({children[1], {i, b, j}}, patch, target);
    subdivide({children[2], {k, j, c}}, patch, target);
    subdivide({children[3], {i, j, k}}, patch, target);
}

}  // namespace

std::vector<PixelOwner> locatePixelsReference(const PatchMesh& mesh, const View& view) {
    TESSERA_CHECK(view.scale.x > 0 && view.scale.y > 0 && view.width >= 0 && view.height >= 0);
    std::vector<PixelOwner> owners(size_t(view.width) * size_t(view.height));
    Target target{view, owners};
    mesh.forEachPatch([&](PatchId p) {
        Piece whole{toPixels(mesh.controlPoints(p)),
                    {Barycentric(1, 0, 0), Barycentric(0, 1, 0), Barycentric(0, 0, 1)}};
        for (glm::dvec2& q : whole.shape.p) q = (q - view.origin) * view.scale;
        subdivide(whole, p, target);
    });
    return owners;
}

Image rasterizeReference(const PatchMesh& mesh, const View& view, double sharpen) {
    const EdgeBlur blur(mesh, sharpen);
    const std::vector<PixelOwner> owners = locatePixelsReference(mesh, view);
    Image image(view.width, view.height, mesh.channels());
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const PixelOwner& owner = owners[size_t(y) * size_t(view.width) + size_t(x)];
            if (!owner.patch.valid()) continue;
            const double v = double(owner.v), w = double(owner.w);
            double colour[kMaxChannels];
            blurredColour(mesh, blur, owner.patch, {1 - v - w, v, w},
                          view.origin + glm::dvec2(x + .5, y + .5) / view.scale, colour);
            for (int c = 0; c < mesh.channels(); ++c) image.at(x, y, c) = float(colour[c]);
        }
    float* const planes[] = {image.plane(0).data(), image.plane(1).data(), image.plane(2).data()};
    toWorking(mesh.colourBasis(), planes, image.plane(0).size());
    return image;
}

}  // namespace tessera
