// See recolour.h.
#include "core/edit/recolour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/edit/distance_grid.h"
#include "core/edit/repaint.h"
#include "core/image/oklab.h"
#include "core/mesh/blur_profile.h"

namespace tessera {

namespace {

Repaint repaintOf(const ColourShift& shift, const glm::dvec3&) {
    if (shift.hueDegrees == 0 && shift.chromaFactor == 1 && shift.lightnessShift == 0)
        return {AffineColour{}, {}, false};
    const double turn = glm::radians(shift.hueDegrees);
    const auto cosine = float(shift.chromaFactor * std::cos(turn));
    const auto sine = float(shift.chromaFactor * std::sin(turn)), lighter = float(shift.lightnessShift);
    return {std::nullopt,
            [=](const PaintedColours& colours, SitePlanes& out) {
                const auto& [l, a, b] = colours.lab;
                for (size_t i = 0; i < colours.count; ++i) {
                    out[0][i] = l[i] + lighter;
                    out[1][i] = cosine * a[i] - sine * b[i];
                    out[2][i] = sine * a[i] + cosine * b[i];
                }
                fromOklab(pointersTo(out).data(), colours.count);
            },
            false};
}

Repaint repaintOf(const ReplaceColour& replace, const glm::dvec3& mean) {
    return {AffineColour{glm::dmat3(1), replace.to - mean}, {}, false};
}

Repaint repaintOf(const Tint& tint, const glm::dvec3&) {
    return {tinted(tint.colour, tint.strength), {}, false};
}

Repaint repaintOf(const Levels& levels, const glm::dvec3&) {
    const double factor = 1 + levels.contrast;
    return {AffineColour{glm::dmat3(factor), glm::dvec3(.5 - .5 * factor + levels.brightness)}, {}, false};
}

Repaint repaintOf(const GradientRecolour& gradient, const glm::dvec3&) {
    if (gradient.strength == 0) return {AffineColour{}, {}, false};
    const glm::dvec2 along = gradient.to - gradient.from;
    const double squared = glm::dot(along, along);
    // The share of the second colour at a point.
    const glm::dvec2 slope = squared > 0 ? along / squared : glm::dvec2(0);
    const auto perX = float(slope.x), perY = float(slope.y), start = float(-glm::dot(gradient.from, slope));
    const auto strength = float(gradient.strength);
    return {std::nullopt,
            [=](const PaintedColours& colours, SitePlanes& out) {
                const auto& [x, y] = colours.point;
                for (int c = 0; c < 3; ++c) {
                    const auto from = float(gradient.fromColour[c]), to = float(gradient.toColour[c]);
                    const SitePlane& now = colours.srgb[size_t(c)];
                    for (size_t i = 0; i < colours.count; ++i) {
                        const float share = std::clamp(start + perX * x[i] + perY * y[i], 0.F, 1.F);
                        const float colour = from + share * (to - from);
                        out[size_t(c)][i] = now[i] + strength * (colour - now[i]);
                    }
                }
            },
            true};
}

Repaint repaintOf(const PaletteShift& shift, const glm::dvec3&) {
    const auto entry = size_t(shift.entry);
    const glm::dvec3 step = toOklab(shift.to) - toOklab(shift.palette.entries[entry].colour);
    std::vector<glm::dvec3> labs;
    for (const PaletteEntry& e : shift.palette.entries) labs.push_back(toOklab(e.colour));
    const double spread = shift.palette.spread;
    return {std::nullopt,
            [=](const PaintedColours& colours, SitePlanes& out) {
                const float* const lab[] = {colours.lab[0].data(), colours.lab[1].data(),
                                            colours.lab[2].data()};
                SitePlane shares;
                paletteShares(labs, spread, entry, lab, colours.count, shares.data());
                for (int c = 0; c < 3; ++c)
                    for (size_t i = 0; i < colours.count; ++i)
                        out[size_t(c)][i] = colours.lab[size_t(c)][i] + float(step[c]) * shares[i];
                fromOklab(pointersTo(out).data(), colours.count);
            },
            false};
}

// Edges of the set, other than features and the picture's border, beyond which the mesh goes on.
std::vector<EdgeId> openBorder(const PatchMesh& mesh, const PatchSet& set) {
    const HalfedgeMesh& c = mesh.connectivity();
    const auto member = membership(mesh, set);
    std::vector<EdgeId> edges;
    for (const PatchId p : set)
        for (const HalfedgeId side : c.sides(p)) {
            const PatchId beyond = c.face(HalfedgeMesh::twin(side));
            const EdgeId e = HalfedgeMesh::edge(side);
            if (beyond.valid() && !member[beyond.index] && !mesh.curve(e).feature) edges.push_back(e);
        }
    return edges;
}

// A border that fades, and what it reaches.
struct Feather {
    PatchSet around;             // outside the set
    std::vector<EdgeId> breaks;  // between what it reaches and locked patches
    PaintWeight weight;
};

// Whether a curve comes nearer to the border than the feather is wide.
bool withinFeather(const PatchMesh& mesh, EdgeId e, const DistanceGrid& distance, double feather) {
    constexpr double kStepsPerFeather = 4, kMostSteps = 4096;
    for (const auto& [from, to] : segmentsOf(mesh, std::array{e})) {
        const double steps =
            std::clamp(std::ceil(kStepsPerFeather * glm::distance(from, to) / feather), 1.0, kMostSteps);
        for (int i = 0; i <= int(steps); ++i)
            if (distance.distance(glm::mix(from, to, i / steps)) < feather) return true;
    }
    return false;
}

Feather featherOf(const PatchMesh& mesh, const PatchSet& set, const std::vector<EdgeId>& border,
                  double featherPx) {
    const HalfedgeMesh& c = mesh.connectivity();
    const auto distance = std::make_shared<const DistanceGrid>(segmentsOf(mesh, border), featherPx);
    auto inside = std::make_shared<const std::vector<uint8_t>>(membership(mesh, set));
    auto reached = *inside;
    Feather result;
    const auto reach = [&](HalfedgeId from) {
        const PatchId p = c.face(HalfedgeMesh::twin(from));
        const EdgeId e = HalfedgeMesh::edge(from);
        if (!p.valid() || reached[p.index] || mesh.curve(e).feature) return;
        if (!withinFeather(mesh, e, *distance, featherPx)) return;
        if (mesh.attributes(p).locked) return result.breaks.push_back(e);
        reached[p.index] = 1;
        result.around.push_back(p);
    };
    for (const PatchId p : set)
        for (const HalfedgeId side : c.sides(p)) reach(side);
    for (size_t i = 0; i < result.around.size(); ++i)
        for (const HalfedgeId side : c.sides(PatchId(result.around[i]))) reach(side);
    result.around = patchSet(std::move(result.around));
    result.weight = [distance, inside, featherPx](PatchId patch, glm::dvec2 point) {
        const double d = distance->distance(point);
        return smoothStep(-featherPx, featherPx, (*inside)[patch.index] ? d : -d);
    };
    return result;
}

}  // namespace

struct Recolourer::State {
    std::vector<EdgeId> border;  // where colours break
    glm::dvec3 mean;             // of the set
    Repainter repainter;

    Touched apply(PatchMesh& mesh, const Recolouring& how, Precision precision) const;
};

Recolourer::Recolourer(PatchMesh start, PatchSet set, RecolourOptions options) {
    PatchSet patches = editable(start, set);
    std::vector<EdgeId> border = openBorder(start, patches);
    const glm::dvec3 mean = meanColour(start, patches);
    PaintWeight weight;
    if (options.featherPx > 0 && !border.empty()) {
        Feather feather = featherOf(start, patches, border, options.featherPx);
        patches = united(patches, feather.around);
        border = std::move(feather.breaks);
        weight = std::move(feather.weight);
    }
    mState = std::make_unique<State>(
        State{std::move(border), mean, Repainter(std::move(start), std::move(patches), std::move(weight))});
}
Recolourer::~Recolourer() = default;
Recolourer::Recolourer(Recolourer&&) noexcept = default;
Recolourer& Recolourer::operator=(Recolourer&&) noexcept = default;

Touched Recolourer::apply(PatchMesh& mesh, const Recolouring& how) const {
    return mState->apply(mesh, how, Precision::Full);
}

Touched Recolourer::preview(PatchMesh& mesh, const Recolouring& how) const {
    return mState->apply(mesh, how, Precision::Quick);
}

Touched Recolourer::State::apply(PatchMesh& mesh, const Recolouring& how, Precision precision) const {
    const Repaint repaint = std::visit([&](const auto& r) { return repaintOf(r, mean); }, how);
    Touched touched;
    touched.patches = repainter.apply(mesh, repaint, precision);
    if (touched.patches.empty()) return touched;
    const auto changed = membership(mesh, touched.patches);
    for (const EdgeId e : border) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const HalfedgeMesh& c = mesh.connectivity();
        EdgeCurve curve = mesh.curve(e);
        const bool reached = changed[c.face(h).index] || changed[c.face(HalfedgeMesh::twin(h)).index];
        if (curve.colourBreak || !reached) continue;
        curve.colourBreak = true;
        mesh.setCurve(e, curve);
        touched.edges.push_back(e);
    }
    std::sort(touched.edges.begin(), touched.edges.end());
    return touched;
}

Touched recolour(PatchMesh& mesh, const PatchSet& set, const Recolouring& how,
                 const RecolourOptions& options) {
    return Recolourer(mesh, set, options).apply(mesh, how);
}

}  // namespace tessera
