// See recolour.h.
#include "core/edit/recolour.h"

#include <algorithm>
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
    const double cosine = shift.chromaFactor * std::cos(turn), sine = shift.chromaFactor * std::sin(turn);
    return {std::nullopt,
            [=](const PaintedColour& c) {
                return fromOklab({c.lab.x + shift.lightnessShift, cosine * c.lab.y - sine * c.lab.z,
                                  sine * c.lab.y + cosine * c.lab.z});
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
    return {std::nullopt,
            [=](const PaintedColour& c) {
                const double share = squared > 0 ? glm::dot(c.point - gradient.from, along) / squared : 0;
                const glm::dvec3 colour =
                    glm::mix(gradient.fromColour, gradient.toColour, std::clamp(share, 0.0, 1.0));
                return glm::mix(c.srgb, colour, gradient.strength);
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
            [=](const PaintedColour& c) {
                return fromOklab(c.lab + paletteShare(labs, spread, entry, c.lab) * step);
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

PaintWeight featherWeight(const PatchMesh& mesh, const std::vector<EdgeId>& border, double feather) {
    auto distance = std::make_shared<const DistanceGrid>(segmentsOf(mesh, border), feather);
    return
        [distance, feather](glm::dvec2 point) { return smoothStep(0, feather, distance->distance(point)); };
}

}  // namespace

struct Recolourer::State {
    PatchSet set;
    std::vector<EdgeId> border;  // where a hard border breaks colours
    glm::dvec3 mean;
    Repainter repainter;

    State(PatchMesh start, PatchSet patches, std::vector<EdgeId> open, const RecolourOptions& options)
        : set(std::move(patches)),
          border(std::move(open)),
          mean(meanColour(start, set)),
          repainter(start, set,
                    options.featherPx > 0 && !border.empty() ? featherWeight(start, border, options.featherPx)
                                                             : PaintWeight{}) {
        if (options.featherPx > 0) border.clear();
    }

    Touched apply(PatchMesh& mesh, const Recolouring& how, Precision precision) const;
};

Recolourer::Recolourer(PatchMesh start, PatchSet set, RecolourOptions options) {
    PatchSet patches = editable(start, set);
    std::vector<EdgeId> open = openBorder(start, patches);
    mState = std::make_unique<State>(std::move(start), std::move(patches), std::move(open), options);
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
