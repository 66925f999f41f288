// A mesh in the numbering of the file: what the codec's coders walk over, as plain arrays that depend on
// nothing but the list of triangles. The numbering is specified in FORMAT.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/mesh/halfedge_mesh.h"

namespace tessera {

struct FileMesh {
    static constexpr uint32_t kNone = 0xFFFFFFFF;

    uint32_t vertexCount = 0;
    std::vector<std::array<uint32_t, 3>> triangles;  // vertices, from the corner a of the patch

    // Derived from the above by deriveFileMesh. Side s of a triangle runs from its corner s to corner s + 1.
    struct Edge {
        uint32_t from = 0, to = 0;  // in the direction of its first triangle
        uint32_t face = 0;          // the first of its triangles, and which side of that it is
        uint8_t side = 0;
        bool border = true;
    };
    std::vector<Edge> edges;                            // in order of first appearance
    std::vector<std::array<uint32_t, 3>> sideEdge;      // edge of each side
    std::vector<std::array<uint32_t, 3>> neighbour;     // triangle across each side, or kNone
    std::vector<std::array<uint8_t, 3>> neighbourSide;  // and which side of that the edge is
    std::vector<uint32_t> borderLoop;                   // sides (3 face + side) in order around the picture

    // Whether side s of a triangle runs as its edge does.
    bool forward(uint32_t face, uint32_t side) const {
        const Edge& e = edges[sideEdge[face][side]];
        return e.face == face && e.side == side;
    }
};

// Fills in the derived arrays. Returns what is wrong with the triangles, empty where nothing is: they must be
// a disc (connected, each edge with one or two triangles of opposite directions, one fan around each vertex,
// one border loop, no handles) that uses every vertex.
std::string deriveFileMesh(FileMesh& mesh);

// The elements of a mesh in file order.
struct FileOrder {
    std::vector<VertexId> vertices;
    std::vector<FaceId> faces;
};

class RangeEncoder;
class RangeDecoder;

// Writes the connectivity and says in which order; empty order where the mesh is not connected.
FileOrder encodeConnectivity(RangeEncoder& coder, const HalfedgeMesh& mesh);
// Reads `faceCount` triangles; what is wrong with them, or empty. Takes memory for faceCount triangles.
std::string decodeConnectivity(RangeDecoder& coder, size_t faceCount, FileMesh& mesh);

}  // namespace tessera
