// See repaint.h.
#include "core/edit/repaint.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/base/parallel.h"
#include "core/edit/colour_fan.h"
#include "core/image/oklab.h"

namespace tessera {

namespace {

// What an affine change in the place of a curved one may be off, on a few points: less than a refit may.
constexpr double kLinearMean = .3 / 255, kLinearMost = 1.2 / 255;
// What such a change with one linear in place may be off on all points.
constexpr double kPlacedMean = .4 / 255, kPlacedMost = 2.0 / 255;
// Of so many patches what a refit needs is kept: 35 kB each.
constexpr size_t kMostKept = 2000;
// Smaller changes are none.
constexpr double kNoChange = 1e-4 / 255;

const std::vector<Barycentric>& probeLattice() {
    static const std::vector<Barycentric> lattice = latticeOf(4);
    return lattice;
}
constexpr size_t kProbeCorners[] = {0, 4, 14};  // a, b, c among them

bool isIdentity(const AffineColour& change) {
    const glm::dmat3 rest = change.matrix - glm::dmat3(1);
    double most = 0;
    for (int i = 0; i < 3; ++i) {
        most = std::max(most, std::abs(change.offset[i]));
        for (int j = 0; j < 3; ++j) most = std::max(most, std::abs(rest[i][j]));
    }
    return most < kNoChange;
}

std::optional<PatchSpline> mixedBy(const PatchMesh& mesh, PatchId p, const AffineColour& change) {
    if (isIdentity(change)) return std::nullopt;
    return mixed(mesh.spline(p), mesh.channels(), mesh.colourBasis(), change);
}

double largest(glm::dvec3 d) {
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
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
    bool even = true;                        // weight 1 everywhere
    bool needsAll = false;                   // few points did not do
    std::vector<double> weights;             // at all sites, else
    std::unique_ptr<const RefitPoints> few;  // where that is not all
    const RefitPoints* sampledAt = nullptr;  // where `colours` are
    PaintedColour mean;                      // of the probes
    PaintedColour beside[3];                 // the mean with a little more of R, G or B
    std::vector<PaintedColour> probes;
    std::vector<double> probeAlphas;
    std::vector<PaintedColour> colours;  // at the points of a refit
    std::vector<double> alphas;
    std::optional<SplineRefit> refit;

    static constexpr double kStep = 1.0 / 64;

    bool untouched() const {
        return !even && std::all_of(weights.begin(), weights.end(), [](double w) { return w <= 0; });
    }

    void probe(const PatchMesh& mesh) {
        if (!probes.empty()) return;
        static const DomainPoints points(probeLattice());
        const BezierTriangle shape = toPixels(mesh.controlPoints(id));
        const auto samples = sampleColours(mesh, id, points);
        for (size_t i = 0; i < samples.size(); ++i) {
            probes.emplace_back(samples[i].srgb, evaluate(shape, probeLattice()[i]));
            probeAlphas.push_back(samples[i].alpha);
        }
        const glm::dvec2 middle = evaluate(shape, Barycentric(1.0 / 3));
        glm::dvec3 sum(0);
        for (const PaintedColour& c : probes) sum += c.srgb;
        mean = PaintedColour(sum / double(probes.size()), middle);
        for (int c = 0; c < 3; ++c) {
            glm::dvec3 colour = mean.srgb;
            colour[c] += colour[c] < .5 ? kStep : -kStep;
            beside[c] = PaintedColour(colour, middle);
        }
    }

    void sample(const PatchMesh& mesh, const RefitPoints& at) {
        if (!colours.empty() && sampledAt == &at) return;
        colours.clear();
        alphas.clear();
        refit.reset();
        sampledAt = &at;
        const BezierTriangle shape = toPixels(mesh.controlPoints(id));
        const auto samples = sampleColours(mesh, id, at.domain);
        colours.reserve(samples.size());
        alphas.reserve(samples.size());
        for (size_t i = 0; i < samples.size(); ++i) {
            colours.emplace_back(samples[i].srgb, evaluate(shape, at.barycentrics[i]));
            alphas.push_back(samples[i].alpha);
        }
    }

    void forget() {
        refit.reset();
        few.reset();
        colours = {};
        alphas = {};
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
            for (const Barycentric& b : RefitPoints::all().barycentrics)
                patch.weights.push_back(weight(patch.id, evaluate(shape, b)));
            patch.even =
                std::all_of(patch.weights.begin(), patch.weights.end(), [](double w) { return w >= 1; });
        }
    });
}

Repainter::Spline Repainter::refitted(const PatchMesh& mesh, Patch& patch, const Repaint& repaint) {
    // What few points cannot settle is looked at closely from then on.
    if (!patch.needsAll) {
        if (!patch.few)
            patch.few = std::make_unique<RefitPoints>(RefitPoints::enoughFor(mesh.spline(patch.id)));
        if (auto spline = refittedAt(mesh, patch, repaint, *patch.few)) return *spline;
        patch.needsAll = true;
    }
    return *refittedAt(mesh, patch, repaint, RefitPoints::all());
}

std::optional<Repainter::Spline> Repainter::refittedAt(const PatchMesh& mesh, Patch& patch,
                                                       const Repaint& repaint, const RefitPoints& at) {
    patch.probe(mesh);
    patch.sample(mesh, at);
    const size_t n = patch.colours.size();
    std::vector<glm::dvec3> colours(n), targets(n);
    double most = 0;
    for (size_t i = 0; i < n; ++i) {
        colours[i] = patch.colours[i].whole;
        const glm::dvec3 full = painted(repaint, patch.colours[i]);
        targets[i] = patch.even ? full : glm::mix(colours[i], full, patch.weights[at.sites[i]]);
        most = std::max(most, largest(targets[i] - colours[i]));
    }
    if (most < kNoChange) return Spline{};
    if (mesh.channels() == 3) {
        const AffineColour guess = patch.even && !repaint.affine ? patch.tangent(repaint) : AffineColour{};
        if (const auto placed = PlacedChange::nearest(guess, at, colours, targets, kPlacedMean, kPlacedMost))
            return Spline(
                withCornersRaised(mixed(mesh.spline(patch.id), 3, mesh.colourBasis(), placed->change),
                                  mesh.colourBasis(), placed->corners));
    }
    std::vector<float> planes(n * kMaxChannels);
    for (size_t i = 0; i < n; ++i) {
        for (int c = 0; c < 3; ++c) planes[size_t(c) * n + i] = float(targets[i][c] * patch.alphas[i]);
        planes[3 * n + i] = float(patch.alphas[i]);
    }
    float* pointers[kMaxChannels];
    for (size_t c = 0; c < kMaxChannels; ++c) pointers[c] = planes.data() + c * n;
    fromWorking(mesh.colourBasis(), pointers, n);
    const std::vector<double> values(planes.begin(), planes.end());
    if (!patch.refit) patch.refit.emplace(mesh.spline(patch.id), at);
    Spline fitted = patch.refit->fit(values, mesh.channels());
    if (!fitted) return std::nullopt;
    return fitted;
}

Repainter::Spline Repainter::repainted(const PatchMesh& mesh, Patch& patch, const Repaint& repaint) {
    if (patch.even && repaint.affine) return mixedBy(mesh, patch.id, *repaint.affine);
    // With alpha a tangent of colours that are not premultiplied says nothing of those that are.
    if (patch.even && !repaint.dependsOnPoint && mesh.channels() == 3) {
        patch.probe(mesh);
        if (const auto change = patch.linearized(repaint)) return mixedBy(mesh, patch.id, *change);
    }
    return refitted(mesh, patch, repaint);
}

Repainter::Spline Repainter::sketched(const PatchMesh& mesh, Patch& patch, const Repaint& repaint) {
    if (patch.even && repaint.affine) return mixedBy(mesh, patch.id, *repaint.affine);
    patch.probe(mesh);
    const AffineColour full = repaint.affine ? *repaint.affine : patch.tangent(repaint);
    if (patch.even && !repaint.dependsOnPoint) return mixedBy(mesh, patch.id, full);
    // In the middle by as much as at the corners in the mean; then what the corners lack.
    double weight = 1;
    if (!patch.even) weight = (patch.weights[0] + patch.weights[1] + patch.weights[2]) / 3;
    const AffineColour change{(1 - weight) * glm::dmat3(1) + weight * full.matrix, weight * full.offset};
    CornerValues values{};
    for (size_t k = 0; k < 3; ++k) {
        const PaintedColour& colour = patch.probes[kProbeCorners[k]];
        const double share = patch.even ? 1 : patch.weights[k];
        const glm::dvec3 lack =
            glm::mix(colour.whole, painted(repaint, colour), share) - change(colour.whole);
        for (int c = 0; c < 3; ++c)
            values[size_t(c)][k] = float(patch.probeAlphas[kProbeCorners[k]] * lack[c]);
    }
    return withCornersRaised(mixed(mesh.spline(patch.id), mesh.channels(), mesh.colourBasis(), change),
                             mesh.colourBasis(), values);
}

PatchSet Repainter::apply(PatchMesh& mesh, const Repaint& repaint, Precision precision) const {
    if (repaint.affine && isIdentity(*repaint.affine)) return {};
    std::vector<std::optional<PatchSpline>> splines(mPatches.size());
    parallelFor(mPatches.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Patch& patch = (*mCache)[i];
            if (patch.untouched()) continue;
            splines[i] = precision == Precision::Full ? repainted(mStart, patch, repaint)
                                                      : sketched(mStart, patch, repaint);
            if (mPatches.size() > kMostKept) patch.forget();
        }
    });
    PatchSet changed;
    std::vector<PatchSpline> fresh;
    fresh.reserve(mPatches.size());
    for (size_t i = 0; i < mPatches.size(); ++i) {
        if (!splines[i]) continue;
        fresh.push_back(std::move(*splines[i]));
        changed.push_back(mPatches[i]);
    }
    mesh.setSplines(changed, std::move(fresh));
    return changed;
}

}  // namespace tessera
