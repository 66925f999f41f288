// The colour of a document at a point, as tools pick it up.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "app/document_session.h"
#include "app/tools/tool_options.h"

namespace tessera {

// Gamma-encoded sRGB, not premultiplied, not clamped: of the patch's own colours (without the blur of
// features), or of the photo; none outside the picture, where it is wholly transparent, and where there is no
// such source.
std::optional<glm::dvec3> colourAt(DocumentSession& session, glm::dvec2 point, ColourSource source);

}  // namespace tessera
