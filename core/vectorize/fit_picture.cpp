// See fit_picture.h.
#include "core/vectorize/fit_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/mesh/bezier.h"
#include "core/mesh/blur_profile.h"
#include "core/mesh/scan_conversion.h"
#include "core/vectorize/site_pursuit.h"

namespace tessera {

namespace {

// What an enlargement makes of a step reaches so far.
constexpr double kStepPx = 2;

// Marks the pixels whose centres are within `reach` px of `curve`.
void markNear(const BezierCurve& curve, double reach, FitGrid& grid) {
    constexpr double kSpacingPx = .5;
    const int pieces = int(std::ceil(curve.length() / kSpacingPx)) + 1;
    for (int i = 0; i <= pieces; ++i) {
        const glm::dvec2 p = curve.at(double(i) / pieces);
        const int x0 = std::max(int(p.x - reach), 0), x1 = std::min(int(p.x + reach), grid.width - 1);
        const int y0 = std::max(int(p.y - reach), 0), y1 = std::min(int(p.y + reach), grid.height - 1);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x)
                if (glm::distance(p, {x + .5, y + .5}) <= reach)
                    grid.whole[size_t(y) * size_t(grid.width) + size_t(x)] = 1;
    }
}

// Of the triangle of the patch's corners, in px.
double leastHeight(const BezierTriangle& patch) {
    double longest = 0;
    for (int s = 0; s < 3; ++s)
        longest = std::max(longest, glm::distance(patch.corner(s), patch.corner((s + 1) % 3)));
    return std::abs(cross(patch.corner(1) - patch.corner(0), patch.corner(2) - patch.corner(0))) / longest;
}

// Marks the pixels of patches with at least one for each row of places where splines may have a centre, along
// every side. Their number alone does not do: in long patches with enough of them splines swing across.
void markWidePatches(const PatchMesh& mesh, double termsPerPatch, FitGrid& grid) {
    const ScanConversion scan(mesh, wholePicture(mesh, {1, 1}));
    std::vector<PixelRun> runs;
    for (size_t i = 0; i < scan.patches().size(); ++i) {
        const PatchId p = scan.patches()[i];
        if (leastHeight(toPixels(mesh.controlPoints(p))) < candidateSteps(termsPerPatch)) continue;
        scan.runs(p, scan.bounds(i), runs);
        for (const PixelRun& run : runs)
            std::fill_n(grid.whole.begin() + ptrdiff_t(run.row) * grid.width + run.begin, run.end - run.begin,
                        uint8_t{1});
    }
}

}  // namespace

FitPicture::FitPicture(const PatchMesh& mesh, double termsPerPatch, const Image& picture, Image fine)
    : grid{picture.width(), picture.height(), fine.width() / picture.width(), {}}, means(std::move(fine)) {
    TESSERA_CHECK(means.width() == picture.width() * grid.perSide &&
                  means.height() == picture.height() * grid.perSide);
    grid.whole.assign(picture.planeSize(), 0);
    mesh.forEachEdge([&](EdgeId e) {
        const EdgeCurve& curve = mesh.curve(e);
        if (!curve.feature) return;
        const double blur = kBlurReach * double(std::max(curve.blurSigma[0], curve.blurSigma[1]));
        markNear(toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e))), std::max(kStepPx, blur), grid);
    });
    markWidePatches(mesh, termsPerPatch, grid);
    parallelFor(size_t(grid.height), 16, [&](size_t begin, size_t end) {
        for (int c = 0; c < picture.channels(); ++c)
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < grid.width; ++x)
                    if (grid.whole[size_t(y) * size_t(grid.width) + size_t(x)])
                        means.at(x * grid.perSide, y * grid.perSide, c) = picture.at(x, y, c);
    });
}

int squaresPerSide(const PatchMesh& mesh, double termsPerPatch) {
    // Measured: with fewer places than the one most patches are wide, with fewer than the other finer squares
    // take their time and give nothing.
    constexpr double kPlacesForTwo = .25, kPlacesForThree = 1.6;  // a pixel
    const double places = double(candidateSites(termsPerPatch).size()) * double(mesh.patchCount());
    const double pixels = double(mesh.width()) * mesh.height();
    return places <= kPlacesForTwo * pixels ? 1 : places <= kPlacesForThree * pixels ? 2 : 3;
}

}  // namespace tessera
