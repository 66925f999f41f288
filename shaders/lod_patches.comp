#version 450 core
// Which patches can be seen, and in how many pieces each has to be split so that no side of a piece needs more
// than the tessellator's level.
#include "include/gpu_layout.glsl"
#include "include/geometry.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer EdgeLevelBuffer { uint edgeLevels[]; };
layout(std430, binding = 1) writeonly buffer PieceBuffer { Piece pieces[]; };
// DrawArraysIndirectCommand.
struct DrawCommand {
    uint count;
    uint instanceCount;
    uint first;
    uint baseInstance;
};
layout(std430, binding = 2) buffer DrawBuffer {
    uint spentVertices;
    DrawCommand draws[];
};

bool seen(vec2 lo, vec2 hi) {
    return all(lessThan(lo, view.gridSize)) && all(greaterThan(hi, vec2(0.0)));
}

// Puts a piece of up to 2^bits segments a side into a draw that has room for its vertices.
void emit(uint p, uint code, uint bits) {
    uint draw = 0u;
    if (view.drawVertices > 0u) {
        const uint n = 1u << min(bits, kTessellatorBits);
        const uint vertices = max((n + 1u) * (n + 2u) / 2u, view.drawVertices / (view.pieceCapacity - 1u) + 1u);
        draw = atomicAdd(spentVertices, vertices) / view.drawVertices;
    }
    if (draw >= view.drawCount) return;
    const uint slot = atomicAdd(draws[draw].count, 1u);
    if (slot < view.pieceCapacity) pieces[draws[draw].first + slot] = Piece(p, code);
}

// Emits the pieces of `depth` that can be seen; those of a part that cannot are passed over.
void emitPieces(uint p, ivec2 lattice[10], float bend, uint depth) {
    dvec2 control[10];
    for (int i = 0; i < 10; ++i) control[i] = toGridExact(lattice[i]);
    uint path = 0u, level = 0u;
    for (;;) {
        vec2 corners[3];
        pieceCorners(level, path, corners);
        vec2 lo = vec2(1e30), hi = vec2(-1e30);
        for (int i = 0; i < 3; ++i) {
            const vec2 at = vec2(patchPoint(control, dvec2(corners[i])));
            lo = min(lo, at);
            hi = max(hi, at);
        }
        // A piece is that near to the triangle of its corners.
        const vec2 margin = vec2(0.75 * bend * exp2(-2.0 * float(level)) + 1.0);
        const bool inView = seen(lo - margin, hi + margin);
        if (inView && level < depth) {
            path <<= 2;
            ++level;
            continue;
        }
        if (inView) emit(p, depth << 28 | path, kTessellatorBits);
        while (level > 0u && (path & 3u) == 3u) {
            path >>= 2;
            --level;
        }
        if (level == 0u) return;
        ++path;
    }
}

void main() {
    const uint p = gl_GlobalInvocationID.x;
    if (p >= view.patchCount) return;
    const PatchShape shape = loadShape(p);
    if (!isDrawn(shape)) return;
    ivec2 lattice[10];
    loadControlPoints(shape, lattice);
    vec2 b[10];
    vec2 lo = vec2(1e30), hi = vec2(-1e30);
    for (int i = 0; i < 10; ++i) {
        b[i] = toGrid(lattice[i]);
        lo = min(lo, b[i]);
        hi = max(hi, b[i]);
    }
    if (!seen(lo, hi)) return;

    const float bend = patchBend(b);
    uint bits = levelBits(bend, view.insideTolerance);
    for (int s = 0; s < 3; ++s) bits = max(bits, edgeLevels[shape.sides[s] >> 1]);
    if (bits <= kTessellatorBits) {
        emit(p, 0u, bits);
        return;
    }
    const uint depth = bits - kTessellatorBits;
    // A side of a piece has at least one segment, seen from the other patch too. That raises no level beyond
    // the tessellator's, so that it matters to no patch when its neighbours do so.
    for (int s = 0; s < 3; ++s) atomicMax(edgeLevels[shape.sides[s] >> 1], depth);
    emitPieces(p, lattice, bend, depth);
}
