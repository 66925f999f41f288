// Simple edits of a mesh, for tests of what surrounds edits.
#pragma once

#include <cstdint>
#include <vector>

#include "core/document/codec.h"
#include "core/edit/touched.h"
#include "core/mesh/patch_mesh.h"

namespace tessera::testing {

// Gives a patch one colour.
inline Touched paint(PatchMesh& mesh, PatchId p, float value) {
    const std::vector<float> colour(size_t(mesh.channels()), value);
    mesh.setSpline(p, constantSpline(colour));
    Touched touched;
    touched.patches = {p};
    return touched;
}

// The bytes that a save would write.
inline std::vector<uint8_t> bytesOf(Document document) {
    return encodeDocument(document).value();
}

}  // namespace tessera::testing
