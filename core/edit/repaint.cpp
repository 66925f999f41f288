// See repaint.h.
#include "core/edit/repaint.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/base/parallel.h"
#include "core/edit/patch_colours.h"
#include "core/image/oklab.h"

namespace tessera {

namespace {

// What an affine change in the place of a curved one may be off, on a few points: less than a refit may.
constexpr double kLinearMean = .3 / 255, kLinearMost = 1.2 / 255;
// Smaller changes are none.
constexpr double kNoChange = 1e-4 / 255;

const DomainPoints& probePoints() {
    static const DomainPoints points(latticeOf(4));
    return points;
}

bool isIdentity(const AffineColour& change) {
    const glm::dmat3 rest = change.matrix - glm::dmat3(1);
    double most = 0;
    for (int i = 0; i < 3; ++i) {
        most = std::max(most, std::abs(change.offset[i]));
        for (int j = 0; j < 3; ++j) most = std::max(most, std::abs(rest[i][j]));
    }
    return most < kNoChange;
}

double largest(glm::dvec3 d) {
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
}

std::vector<PaintedColour> paintedColours(const PatchMesh& mesh, PatchId p, const DomainPoints& points) {
    std::vector<PaintedColour> colours;
    for (const ColourSample& s : sampleColours(mesh, p, points)) colours.emplace_back(s.srgb);
    return colours;
}

glm::dvec3 painted(const Repaint& repaint, const PaintedColour& colour) {
    return repaint.affine ? (*repaint.affine)(colour.whole) : repaint.function(colour);
}

}  // namespace

PaintedColour::PaintedColour(glm::dvec3 colour, glm::dvec2 at)
    : srgb(glm::clamp(colour, 0.0, 1.0)), lab(toOklab(srgb)), point(at), whole(colour) {}

// The colours at the points that repaintings look at, and the factors of refits.
struct Repainter::Patch {
    PatchId id;
    bool even = true;             // weight 1 everywhere
    std::vector<double> weights;  // at the points of a refit, else
    PaintedColour mean;           // of the probes
    PaintedColour beside[3];      // the mean with a little more of R, G or B
    std::vector<PaintedColour> probes;
    std::vector<PaintedColour> colours;  // at the points of a refit
    std::vector<double> alphas;
    std::optional<SplineRefit> refit;

    static constexpr double kStep = 1.0 / 64;

    void probe(const PatchMesh& mesh) {
        if (!probes.empty()) return;
        probes = paintedColours(mesh, id, probePoints());
        glm::dvec3 sum(0);
        for (const PaintedColour& c : probes) sum += c.srgb;
        mean = PaintedColour(sum / double(probes.size()));
        for (int c = 0; c < 3; ++c) {
            glm::dvec3 colour = mean.srgb;
            colour[c] += colour[c] < .5 ? kStep : -kStep;
            beside[c] = PaintedColour(colour);
        }
    }

    void sample(const PatchMesh& mesh) {
        if (!colours.empty()) return;
        const BezierTriangle shape = toPixels(mesh.controlPoints(id));
        const auto samples = sampleColours(mesh, id, SplineRefit::points());
        for (size_t i = 0; i < samples.size(); ++i) {
            colours.emplace_back(samples[i].srgb, evaluate(shape, SplineRefit::barycentrics()[i]));
            alphas.push_back(samples[i].alpha);
        }
        refit.emplace(mesh.spline(id));
    }

    // The tangent of a repainting at the mean colour.
    AffineColour tangent(const Repaint& repaint) const {
        AffineColour change;
        const glm::dvec3 at = repaint.function(mean);
        for (int c = 0; c < 3; ++c)
            change.matrix[c] = (repaint.function(beside[c]) - at) / (beside[c].srgb[c] - mean.srgb[c]);
        change.offset = at - change.matrix * mean.srgb;
        return change;
    }

    // The same, where it follows the repainting at all probes.
    std::optional<AffineColour> linearized(const Repaint& repaint) const {
        const AffineColour change = tangent(repaint);
        double sum = 0;
        for (const PaintedColour& probe : probes) {
            const glm::dvec3 off = glm::abs(change(probe.whole) - painted(repaint, probe));
            if (largest(off) > kLinearMost) return std::nullopt;
            sum += off.x + off.y + off.z;
        }
        if (sum > 3 * kLinearMean * double(probes.size())) return std::nullopt;
        return change;
    }
};

Repainter::Repainter(PatchMesh start, PatchSet patches, PaintWeight weight)
    : mStart(std::move(start)),
      mPatches(std::move(patches)),
      mCache(std::make_shared<std::vector<Patch>>(mPatches.size())) {
    parallelFor(mPatches.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Patch& patch = (*mCache)[i];
            patch.id = mPatches[i];
            if (!weight) continue;
            const BezierTriangle shape = toPixels(mStart.controlPoints(patch.id));
            for (const Barycentric& b : SplineRefit::barycentrics())
                patch.weights.push_back(weight(evaluate(shape, b)));
            patch.even =
                std::all_of(patch.weights.begin(), patch.weights.end(), [](double w) { return w >= 1; });
        }
    });
}

std::optional<PatchSpline> Repainter::refitted(const PatchMesh& mesh, Patch& patch, const Repaint& repaint,
                                               Precision precision) {
    patch.sample(mesh);
    const size_t n = patch.colours.size();
    std::vector<float> planes(n * kMaxChannels);
    double most = 0;
    for (size_t i = 0; i < n; ++i) {
        const glm::dvec3 colour = patch.colours[i].whole, full = painted(repaint, patch.colours[i]);
        const glm::dvec3 mixture = patch.even ? full : glm::mix(colour, full, patch.weights[i]);
        most = std::max(most, largest(mixture - colour));
        for (int c = 0; c < 3; ++c) planes[size_t(c) * n + i] = float(mixture[c] * patch.alphas[i]);
        planes[3 * n + i] = float(patch.alphas[i]);
    }
    if (most < kNoChange) return std::nullopt;
    float* pointers[kMaxChannels];
    for (size_t c = 0; c < kMaxChannels; ++c) pointers[c] = planes.data() + c * n;
    fromWorking(mesh.colourBasis(), pointers, n);
    const std::vector<double> values(planes.begin(), planes.end());
    return patch.refit->fit(values, mesh.channels(), precision == Precision::Full);
}

std::optional<PatchSpline> Repainter::repainted(const PatchMesh& mesh, Patch& patch, const Repaint& repaint,
                                                Precision precision) {
    const auto mixedBy = [&](const AffineColour& change) -> std::optional<PatchSpline> {
        if (isIdentity(change)) return std::nullopt;
        return mixed(mesh.spline(patch.id), mesh.channels(), mesh.colourBasis(), change);
    };
    if (!patch.even &&
        std::all_of(patch.weights.begin(), patch.weights.end(), [](double w) { return w <= 0; }))
        return std::nullopt;
    if (patch.even && repaint.affine) return mixedBy(*repaint.affine);
    // With alpha a tangent of colours that are not premultiplied says nothing of those that are.
    if (patch.even && !repaint.dependsOnPoint && mesh.channels() == 3) {
        patch.probe(mesh);
        if (precision == Precision::Quick) return mixedBy(patch.tangent(repaint));
        if (const auto change = patch.linearized(repaint)) return mixedBy(*change);
    }
    return refitted(mesh, patch, repaint, precision);
}

PatchSet Repainter::apply(PatchMesh& mesh, const Repaint& repaint, Precision precision) const {
    if (repaint.affine && isIdentity(*repaint.affine)) return {};
    std::vector<std::optional<PatchSpline>> splines(mPatches.size());
    parallelFor(mPatches.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) splines[i] = repainted(mStart, (*mCache)[i], repaint, precision);
    });
    PatchSet changed;
    for (size_t i = 0; i < mPatches.size(); ++i) {
        if (!splines[i]) continue;
        mesh.setSpline(mPatches[i], std::move(*splines[i]));
        changed.push_back(mPatches[i]);
    }
    return changed;
}

}  // namespace tessera
