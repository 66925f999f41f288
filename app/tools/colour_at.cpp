// See colour_at.h.
#include "app/tools/colour_at.h"

#include "core/edit/colour_samples.h"

namespace tessera {

namespace {

std::optional<glm::dvec3> photoColour(const Image& photo, glm::dvec2 point) {
    if (point.x < 0 || point.y < 0 || point.x > photo.width() || point.y > photo.height()) return {};
    const double alpha = photo.hasAlpha() ? double(bilinear(photo, 3, point.x, point.y)) : 1;
    if (alpha <= kLeastAlpha) return {};
    glm::dvec3 colour;
    for (int c = 0; c < 3; ++c) colour[c] = double(bilinear(photo, c, point.x, point.y)) / alpha;
    return colour;
}

}  // namespace

std::optional<glm::dvec3> colourAt(DocumentSession& session, glm::dvec2 point, ColourSource source) {
    if (source == ColourSource::Original || !session.hasMesh()) {
        const std::shared_ptr<const Image> photo = session.photo().image;
        return photo ? photoColour(*photo, point) : std::nullopt;
    }
    const auto hit = session.query().patchAt(point);
    if (!hit || session.document().mesh.attributes(hit->patch).cutOut) return {};
    const ColourSample sample = sampleColour(session.document().mesh, hit->patch, hit->at);
    if (sample.alpha <= kLeastAlpha) return {};
    return sample.srgb;
}

}  // namespace tessera
