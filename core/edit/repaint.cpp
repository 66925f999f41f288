// See repaint.h.
#include "core/edit/repaint.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/edit/colour_fan.h"
#include "core/edit/placed_change.h"
#include "core/edit/site_fit.h"
#include "core/image/oklab.h"
#include "core/mesh/prefetch.h"

namespace tessera {

namespace {

// What an affine change in the place of a curved one may be off, on a few points: less than a fit may.
constexpr double kLinearMean = .3 / 255, kLinearMost = 1.2 / 255;
// What such a change with one linear in place may be off on all sites.
constexpr double kPlacedMean = .4 / 255, kPlacedMost = 2.0 / 255;
// Smaller changes are none.
constexpr double kNoChange = 1e-4 / 255;
// A tangent is taken over such a part of the range of R, G or B.
constexpr double kStep = 1.0 / 64;
constexpr size_t kTangent = 4;  // colours: one, and those beside it

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

glm::dvec3 colourAt(std::span<const SitePlane> planes, size_t i) {
    return {double(planes[0][i]), double(planes[1][i]), double(planes[2][i])};
}

// A colour and those with a little more of R, G or B.
void addTangent(PaintedColours& colours, glm::dvec3 middle, glm::dvec2 point) {
    middle = glm::clamp(middle, 0.0, 1.0);
    colours.add(middle, point);
    for (int c = 0; c < 3; ++c) {
        glm::dvec3 beside = middle;
        beside[c] += middle[c] < .5 ? kStep : -kStep;
        colours.add(beside, point);
    }
}

// The tangent of a repainting from what it makes of those, which are from `first` on.
AffineColour tangentOf(const PaintedColours& colours, const SitePlanes& painted, size_t first) {
    AffineColour change;
    const glm::dvec3 from = colourAt(colours.srgb, first), to = colourAt(painted, first);
    for (size_t c = 0; c < 3; ++c)
        change.matrix[int(c)] = (colourAt(painted, first + 1 + c) - to) /
                                double(colours.srgb[c][first + 1 + c] - colours.srgb[c][first]);
    change.offset = to - change.matrix * from;
    return change;
}

void paint(const Repaint& repaint, const PaintedColours& colours, SitePlanes& painted) {
    if (!repaint.affine) return repaint.function(colours, painted);
    for (size_t i = 0; i < colours.count; ++i) {
        const glm::dvec3 to = (*repaint.affine)(colourAt(colours.whole, i));
        for (int c = 0; c < 3; ++c) painted[size_t(c)][i] = float(to[c]);
    }
}

// So many patches ahead a frame asks for splines.
constexpr size_t kAhead = 4;

glm::dvec2 middleOf(const BezierTriangle& shape) {
    return evaluate(shape, Barycentric(1.0 / 3));
}

}  // namespace

void PaintedColours::add(glm::dvec3 colour, glm::dvec2 at) {
    TESSERA_CHECK(count < kSitePlane);
    for (int c = 0; c < 3; ++c) {
        whole[size_t(c)][count] = float(colour[c]);
        srgb[size_t(c)][count] = float(std::clamp(colour[c], 0.0, 1.0));
    }
    point[0][count] = float(at.x);
    point[1][count] = float(at.y);
    ++count;
}

void PaintedColours::makeLab() {
    lab = srgb;
    float* const planes[3] = {lab[0].data(), lab[1].data(), lab[2].data()};
    toOklab(planes, count);
}

struct Repainter::Patch {
    PatchId id;
    bool even = true;            // weight 1 everywhere
    std::vector<float> weights;  // at all sites, else

    bool untouched() const {
        return !even && std::all_of(weights.begin(), weights.end(), [](float w) { return w <= 0; });
    }
    // Of the corners, which are the first sites.
    double weight(size_t corner) const { return even ? 1 : double(weights[corner]); }
};

// Patches whose colours are repainted at once in the frames of a gesture.
struct Repainter::Group {
    static constexpr size_t kMost = kSitePlane / kTangent;

    std::vector<Patch> patches;
    bool looked = false;
    // Of each patch: the tangent's colours, about the mean of its probes; the corners with their alphas.
    PaintedColours tangents{}, corners{};
    std::vector<float> alphas;
};

namespace {

// The colours of a patch on a small lattice.
void addProbes(const PatchMesh& mesh, PatchId p, const BezierTriangle& shape, PaintedColours& to,
               std::vector<float>& alphas) {
    static const DomainPoints points(probeLattice());
    const auto samples = sampleColours(mesh, p, points);
    for (size_t i = 0; i < samples.size(); ++i) {
        to.add(samples[i].srgb, evaluate(shape, probeLattice()[i]));
        alphas.push_back(float(samples[i].alpha));
    }
}

glm::dvec3 meanOf(const PaintedColours& colours) {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < colours.count; ++i) sum += colourAt(colours.srgb, i);
    return sum / double(colours.count);
}

// A patch's points at the sites by its control points' shares in them.
TESSERA_VECTOR_CLONES
void placesOf(const std::array<SitePlane, 10>& shares, const BezierTriangle& shape,
              std::array<SitePlane, 2>& places) {
    for (int axis = 0; axis < 2; ++axis)
        for (size_t i = 0; i < kSitePlane; ++i) {
            float sum = 0;
            for (size_t k = 0; k < 10; ++k) sum += shares[k][i] * float(shape.p[k][axis]);
            places[size_t(axis)][i] = sum;
        }
}

const std::array<SitePlane, 10>& controlShares() {
    static const auto shares = [] {
        std::array<SitePlane, 10> all{};
        for (size_t k = 0; k < 10; ++k) {
            BezierTriangle one{};
            one.p[k] = {1, 0};
            for (size_t i = 0; i < size_t(kCentreSites); ++i)
                all[k][i] = float(evaluate(one, sitePoints().barycentrics[i]).x);
        }
        return all;
    }();
    return shares;
}

// The colours of a patch at all sites, with their places where they are asked for; and the alphas.
void sampleSites(const PatchMesh& mesh, PatchId p, bool placed, PaintedColours& to, SitePlane& alphas) {
    const DomainPoints& points = sitePoints().domain;
    const size_t n = points.size();
    SitePlanes values{};
    const auto planes = pointersTo(values);
    evaluateSplines(mesh.spline(p), mesh.channels(), points.x.data(), points.y.data(), n, planes.data());
    toWorking(mesh.colourBasis(), planes.data(), n);
    alphas.fill(1);
    if (mesh.channels() == 4) {
        alphas = values[3];
        for (size_t c = 0; c < 3; ++c)
            for (size_t i = 0; i < n; ++i) values[c][i] /= std::max(alphas[i], float(kLeastAlpha));
    }
    to.count = n;
    for (size_t c = 0; c < 3; ++c) {
        to.whole[c] = values[c];
        for (size_t i = 0; i < kSitePlane; ++i) to.srgb[c][i] = std::clamp(values[c][i], 0.F, 1.F);
    }
    if (placed) placesOf(controlShares(), toPixels(mesh.controlPoints(p)), to.point);
    to.makeLab();
}

}  // namespace

Repainter::Repainter(PatchMesh start, PatchSet patches, PaintWeight weight)
    : mStart(std::move(start)),
      mPatches(std::move(patches)),
      mGroups(std::make_shared<std::vector<Group>>((mPatches.size() + Group::kMost - 1) / Group::kMost)) {
    parallelFor(mGroups->size(), 1, [&](size_t begin, size_t end) {
        for (size_t g = begin; g < end; ++g) {
            const size_t first = g * Group::kMost;
            auto& group = (*mGroups)[g].patches;
            group.resize(std::min(Group::kMost, mPatches.size() - first));
            for (size_t i = 0; i < group.size(); ++i) {
                Patch& patch = group[i];
                patch.id = mPatches[first + i];
                if (!weight) continue;
                const BezierTriangle shape = toPixels(mStart.controlPoints(patch.id));
                for (const Barycentric& b : sitePoints().barycentrics)
                    patch.weights.push_back(float(weight(patch.id, evaluate(shape, b))));
                patch.even =
                    std::all_of(patch.weights.begin(), patch.weights.end(), [](float w) { return w >= 1; });
            }
        }
    });
}

Repainter::Spline Repainter::refitted(const Patch& patch, const Repaint& repaint,
                                      const AffineColour& guess) const {
    PaintedColours colours{};
    SitePlane alphas;
    sampleSites(mStart, patch.id, repaint.dependsOnPoint, colours, alphas);
    SitePlanes targets{}, whole{};
    paint(repaint, colours, targets);
    float most = 0;
    for (size_t c = 0; c < 3; ++c) {
        whole[c] = colours.whole[c];
        for (size_t i = 0; i < colours.count; ++i) {
            if (!patch.even) targets[c][i] = whole[c][i] + patch.weights[i] * (targets[c][i] - whole[c][i]);
            most = std::max(most, std::abs(targets[c][i] - whole[c][i]));
        }
    }
    if (double(most) < kNoChange) return std::nullopt;
    PatchSpline spline = mStart.spline(patch.id);
    SitePlanes rest{};
    const auto planes = pointersTo(rest);
    if (mStart.channels() == 3) {
        const PlacedChange placed = PlacedChange::nearest(guess, whole, targets, rest);
        spline = withCornersRaised(mixed(spline, 3, mStart.colourBasis(), placed.change),
                                   mStart.colourBasis(), placed.corners);
        if (placed.mean <= kPlacedMean && placed.most <= kPlacedMost) return spline;
    } else {
        for (size_t c = 0; c < 3; ++c)
            for (size_t i = 0; i < colours.count; ++i) rest[c][i] = alphas[i] * (targets[c][i] - whole[c][i]);
    }
    fromWorking(mStart.colourBasis(), planes.data(), colours.count);
    return withAdded(spline, mStart.channels(), rest);
}

Repainter::Spline Repainter::repainted(const Patch& patch, const Repaint& repaint) const {
    const auto mixedBy = [&](const AffineColour& change) -> Spline {
        if (isIdentity(change)) return std::nullopt;
        return mixed(mStart.spline(patch.id), mStart.channels(), mStart.colourBasis(), change);
    };
    if (patch.even && repaint.affine) return mixedBy(*repaint.affine);
    if (!patch.even || repaint.affine || mStart.channels() == 4) return refitted(patch, repaint, {});
    PaintedColours colours{};
    std::vector<float> alphas;
    const BezierTriangle shape = toPixels(mStart.controlPoints(patch.id));
    addProbes(mStart, patch.id, shape, colours, alphas);
    const size_t probes = colours.count;
    addTangent(colours, meanOf(colours), middleOf(shape));
    colours.makeLab();
    SitePlanes painted{};
    paint(repaint, colours, painted);
    const AffineColour tangent = tangentOf(colours, painted, probes);
    if (repaint.dependsOnPoint) return refitted(patch, repaint, tangent);
    double sum = 0, most = 0;
    for (size_t i = 0; i < probes; ++i) {
        const glm::dvec3 off = glm::abs(tangent(colourAt(colours.whole, i)) - colourAt(painted, i));
        most = std::max({most, off.x, off.y, off.z});
        sum += off.x + off.y + off.z;
    }
    if (most <= kLinearMost && sum <= 3 * kLinearMean * double(probes)) return mixedBy(tangent);
    return refitted(patch, repaint, tangent);
}

void Repainter::look(Group& group) const {
    if (group.looked) return;
    group.looked = true;
    PaintedColours probes{};
    std::vector<float> alphas;
    for (const Patch& patch : group.patches) {
        const BezierTriangle shape = toPixels(mStart.controlPoints(patch.id));
        probes.count = 0;
        alphas.clear();
        addProbes(mStart, patch.id, shape, probes, alphas);
        addTangent(group.tangents, meanOf(probes), middleOf(shape));
        for (const size_t corner : kProbeCorners) {
            group.corners.add(colourAt(probes.whole, corner), colourAt(probes.point, corner));
            group.alphas.push_back(alphas[corner]);
        }
    }
    group.tangents.makeLab();
    group.corners.makeLab();
}

void Repainter::sketch(Group& group, const Repaint& repaint, std::span<Spline> splines) const {
    const bool even = std::all_of(group.patches.begin(), group.patches.end(),
                                  [](const Patch& patch) { return patch.even; });
    const bool placed = repaint.dependsOnPoint || !even;
    if (placed || !repaint.affine) look(group);
    SitePlanes tangents{}, corners{};
    if (!repaint.affine) paint(repaint, group.tangents, tangents);
    if (placed) paint(repaint, group.corners, corners);
    for (size_t i = 0; i < group.patches.size(); ++i) {
        if (i + kAhead < group.patches.size()) prefetch(mStart.spline(group.patches[i + kAhead].id));
        const Patch& patch = group.patches[i];
        if (patch.untouched()) continue;
        const PatchSpline& spline = mStart.spline(patch.id);
        const AffineColour full =
            repaint.affine ? *repaint.affine : tangentOf(group.tangents, tangents, kTangent * i);
        if (patch.even && !repaint.dependsOnPoint) {
            if (!isIdentity(full)) splines[i] = mixed(spline, mStart.channels(), mStart.colourBasis(), full);
            continue;
        }
        // In the middle by as much as at the corners in the mean; then what the corners lack.
        const double weight = (patch.weight(0) + patch.weight(1) + patch.weight(2)) / 3;
        const AffineColour change{(1 - weight) * glm::dmat3(1) + weight * full.matrix, weight * full.offset};
        CornerValues values{};
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec3 colour = colourAt(group.corners.whole, 3 * i + k);
            const glm::dvec3 lack =
                glm::mix(colour, colourAt(corners, 3 * i + k), patch.weight(k)) - change(colour);
            for (int c = 0; c < 3; ++c)
                values[size_t(c)][k] = float(double(group.alphas[3 * i + k]) * lack[c]);
        }
        splines[i] = withCornersRaised(mixed(spline, mStart.channels(), mStart.colourBasis(), change),
                                       mStart.colourBasis(), values);
    }
}

PatchSet Repainter::apply(PatchMesh& mesh, const Repaint& repaint, Precision precision) const {
    if (repaint.affine && isIdentity(*repaint.affine)) return {};
    std::vector<Spline> splines(mPatches.size());
    parallelFor(mGroups->size(), 1, [&](size_t begin, size_t end) {
        for (size_t g = begin; g < end; ++g) {
            Group& group = (*mGroups)[g];
            const auto to = std::span(splines).subspan(g * Group::kMost, group.patches.size());
            if (precision == Precision::Quick) {
                sketch(group, repaint, to);
                continue;
            }
            for (size_t i = 0; i < to.size(); ++i)
                if (!group.patches[i].untouched()) to[i] = repainted(group.patches[i], repaint);
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
