#version 450 core
// Levels of a piece: those of the edges on its sides on a patch's side, and one for all sides inside it.
#include "include/gpu_layout.glsl"
#include "include/geometry.glsl"

layout(vertices = 1) out;

flat in uint vPiece[];
patch out uint tPatch;
patch out uint tExact;
patch out uvec3 tSides;
patch out vec3 tLevels;  // of the sides from corner 0, 1, 2
patch out vec2 tCorners[3];
patch out vec2 tControl[10];

void main() {
    const Piece piece = loadPiece(vPiece[0]);
    const uint depth = pieceDepth(piece.code);
    const PatchShape shape = loadShape(piece.patchId);
    ivec2 lattice[10];
    loadControlPoints(shape, lattice);
    vec2 b[10];
    float extent = 0.0;
    for (int i = 0; i < 10; ++i) {
        b[i] = toGrid(lattice[i]);
        tControl[i] = b[i];
        extent = max(extent, max(abs(b[i].x), abs(b[i].y)));
    }
    const uint bits = levelBits(patchBend(b), view.insideTolerance);
    const uint insideBits = min(bits - min(bits, depth), kTessellatorBits);

    vec2 corners[3];
    pieceCorners(depth, piece.code, corners);
    tPatch = piece.patchId;
    tSides = shape.sides;
    tExact = extent > kExactBeyond ? 1u : 0u;
    for (int i = 0; i < 3; ++i) {
        tCorners[i] = corners[i];
        const vec2 from = corners[i], to = corners[(i + 1) % 3];
        const int side = from.y == 0.0 && to.y == 0.0                       ? 0
                         : from.x + from.y == 1.0 && to.x + to.y == 1.0     ? 1
                         : from.x == 0.0 && to.x == 0.0                     ? 2
                                                                            : -1;
        const uint sideBits =
            side < 0 ? insideBits : loadEdgeLevel(shape.sides[side] >> 1) - depth;
        tLevels[i] = float(1u << sideBits);
    }
    // Outer level i is that of the side opposite corner i.
    gl_TessLevelOuter[0] = tLevels[1];
    gl_TessLevelOuter[1] = tLevels[2];
    gl_TessLevelOuter[2] = tLevels[0];
    gl_TessLevelInner[0] = float(1u << insideBits);
}
