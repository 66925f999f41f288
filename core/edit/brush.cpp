// See brush.h.
#include "core/edit/brush.h"

#include <algorithm>
#include <glm/common.hpp>
#include <memory>

#include "core/edit/distance_grid.h"
#include "core/edit/repaint.h"
#include "core/mesh/blur_profile.h"

namespace tessera {

Touched brush(PatchMesh& mesh, const PatchQuery& query, std::span<const glm::dvec2> stroke,
              const BrushOptions& options) {
    if (stroke.empty() || options.radiusPx <= 0) return {};
    std::vector<LineSegment> segments;
    std::vector<PatchId> under;
    for (size_t i = 0; i < stroke.size(); ++i) {
        const glm::dvec2 from = stroke[i > 0 ? i - 1 : 0], to = stroke[i], reach(options.radiusPx);
        segments.emplace_back(from, to);
        const auto near = query.patchesIn({glm::min(from, to) - reach, glm::max(from, to) + reach});
        under.insert(under.end(), near.begin(), near.end());
    }
    const auto distance = std::make_shared<const DistanceGrid>(std::move(segments), options.radiusPx);
    const double full = std::clamp(options.hardness, 0.0, .99) * options.radiusPx;
    Repaint repaint;
    repaint.affine = options.keepShading
                         ? tinted(options.colour, options.strength)
                         : AffineColour{glm::dmat3(1 - options.strength), options.strength * options.colour};
    Touched touched;
    touched.patches = Repainter(mesh, editable(mesh, patchSet(std::move(under))), [&](glm::dvec2 point) {
                          return 1 - smoothStep(full, options.radiusPx, distance->distance(point));
                      }).apply(mesh, repaint);
    return touched;
}

}  // namespace tessera
