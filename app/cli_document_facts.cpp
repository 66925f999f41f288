// See cli_document_facts.h.
#include "app/cli_document_facts.h"

namespace tessera::cli {

Json countsOf(const PatchMesh& mesh) {
    size_t features = 0;
    mesh.forEachEdge([&](EdgeId e) { features += mesh.curve(e).feature; });
    Json json;
    json["patches"] = mesh.patchCount();
    json["vertices"] = mesh.connectivity().vertexCount();
    json["curves"] = mesh.connectivity().edgeCount();
    json["features"] = features;
    return json;
}

size_t coefficientCount(const PatchMesh& mesh) {
    size_t count = 0;
    mesh.forEachPatch([&](PatchId p) { count += mesh.spline(p).coefficients.size(); });
    return count;
}

}  // namespace tessera::cli
