// See brush.h.
#include "core/edit/brush.h"

#include <algorithm>
#include <glm/common.hpp>
#include <memory>

#include "core/edit/distance_grid.h"
#include "core/edit/repaint.h"
#include "core/mesh/blur_profile.h"

namespace tessera {

BrushStroke::BrushStroke(PatchMesh start, const PatchQuery& query, const BrushOptions& options)
    : mStart(std::move(start)), mPainted(mStart), mQuery(query), mOptions(options) {}

Touched BrushStroke::draw(PatchMesh& mesh, std::span<const glm::dvec2> stroke) {
    if (mOptions.radiusPx <= 0) return {};
    std::vector<PatchId> under;  // of what is new
    while (mSegments.size() < stroke.size()) {
        const size_t i = mSegments.size();
        const glm::dvec2 from = stroke[i > 0 ? i - 1 : 0], to = stroke[i], reach(mOptions.radiusPx);
        mSegments.emplace_back(from, to);
        const auto near = mQuery.patchesIn({glm::min(from, to) - reach, glm::max(from, to) + reach});
        under.insert(under.end(), near.begin(), near.end());
    }
    if (!under.empty()) {
        const auto distance = std::make_shared<const DistanceGrid>(mSegments, mOptions.radiusPx);
        const double full = std::clamp(mOptions.hardness, 0.0, .99) * mOptions.radiusPx;
        Repaint repaint;
        repaint.affine = mOptions.keepShading ? tinted(mOptions.colour, mOptions.strength)
                                              : AffineColour{glm::dmat3(1 - mOptions.strength),
                                                             mOptions.strength * mOptions.colour};
        // What was under the stroke before and is again is painted from its start.
        const Repainter repainter(
            mStart, editable(mStart, patchSet(std::move(under))), [&](PatchId, glm::dvec2 point) {
                return 1 - smoothStep(full, mOptions.radiusPx, distance->distance(point));
            });
        mTouched = united(mTouched, repainter.apply(mPainted, repaint));
    }
    mesh = mPainted;
    Touched touched;
    touched.patches = mTouched;
    return touched;
}

Touched brush(PatchMesh& mesh, const PatchQuery& query, std::span<const glm::dvec2> stroke,
              const BrushOptions& options) {
    return BrushStroke(mesh, query, options).draw(mesh, stroke);
}

}  // namespace tessera
