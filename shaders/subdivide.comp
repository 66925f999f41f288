#version 450 core
// Section 5 of the paper as it stands: every patch is subdivided 4-way until a piece's bounding box is smaller
// than a sample; the sample whose centre is in a piece gets its parameters by barycentric interpolation. An
// invocation hands the four parts of a large piece on to the next dispatch and subdivides a small one itself
// (drivers limit how long a loop runs).
#include "include/gpu_layout.glsl"
#include "include/geometry.glsl"

layout(local_size_x = 64) in;
layout(rg32ui, binding = 0) writeonly uniform uimage2D visibility;
// The first three members are the next dispatch's.
layout(std430, binding = 0) readonly buffer PieceQueue {
    uint groups[3];
    uint count;
    uvec2 pieces[];  // as Piece
}
queue;
layout(std430, binding = 1) buffer NextPieceQueue {
    uint groups[3];
    uint count;
    uvec2 pieces[];
}
next;

const float kSmall = 8.0;      // samples
const uint kLastDepth = 14u;   // a path has 28 bits
const float kRounding = 1e-3;  // samples: neither do pieces leave out what is on their sides

ivec2 lattice[10];
vec2 control[10];
bool exact = false;
float bend = 0.0;

vec2 positionAt(vec2 vw) {
    if (!exact) return patchPoint(control, vw);
    dvec2 precise_[10];
    for (int i = 0; i < 10; ++i) precise_[i] = toGridExact(lattice[i]);
    return vec2(patchPoint(precise_, dvec2(vw)));
}

// The sample at `at`, where it is in the triangle.
void place(uint p, ivec2 at, vec2 corners[3], vec2 b[3]) {
    const vec2 point = vec2(at) + 0.5, e1 = b[1] - b[0], e2 = b[2] - b[0], to = point - b[0];
    const float area = e1.x * e2.y - e1.y * e2.x;
    if (area == 0.0) return;
    const float v = (to.x * e2.y - to.y * e2.x) / area, w = (e1.x * to.y - e1.y * to.x) / area;
    const float slack = kRounding / sqrt(abs(area));
    if (v < -slack || w < -slack || v + w > 1.0 + slack) return;
    const vec2 vw = corners[0] + v * (corners[1] - corners[0]) + w * (corners[2] - corners[0]);
    imageStore(visibility, at, uvec4(p, packUnorm2x16(vw), 0u, 0u));
}

// The corners of a piece, in the domain and in samples, and a box that holds it.
void locate(uint level, uint path, out vec2 corners[3], out vec2 b[3], out vec2 lo, out vec2 hi) {
    pieceCorners(level, path, corners);
    for (int i = 0; i < 3; ++i) b[i] = positionAt(corners[i]);
    // It is that near to the triangle of its corners.
    const vec2 margin = vec2(0.75 * bend * exp2(-2.0 * float(level)));
    lo = min(b[0], min(b[1], b[2])) - margin;
    hi = max(b[0], max(b[1], b[2])) + margin;
}

bool inView(vec2 lo, vec2 hi) {
    return all(lessThan(lo, view.gridSize)) && all(greaterThan(hi, vec2(0.0)));
}

void subdivide(uint p, uint rootLevel, uint root) {
    uint path = root, level = rootLevel;
    for (;;) {
        vec2 corners[3], b[3], lo, hi;
        locate(level, path, corners, b, lo, hi);
        const bool seen = inView(lo, hi);
        if (seen && level < kLastDepth && any(greaterThan(hi - lo, vec2(1.0)))) {
            path <<= 2;
            ++level;
            continue;
        }
        if (seen) {
            const ivec2 first = max(ivec2(ceil(lo - 0.5 - kRounding)), ivec2(0)),
                        last = min(ivec2(floor(hi - 0.5 + kRounding)), ivec2(view.gridSize) - 1);
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x) place(p, ivec2(x, y), corners, b);
        }
        while (level > rootLevel && (path & 3u) == 3u) {
            path >>= 2;
            --level;
        }
        if (level == rootLevel) return;
        ++path;
    }
}

void handOn(uint p, uint level, uint path) {
    const uint first = atomicAdd(next.count, 4u);
    if (first + 4u > uint(next.pieces.length())) return;
    for (uint child = 0u; child < 4u; ++child)
        next.pieces[first + child] = uvec2(p, (level + 1u) << 28 | path << 2 | child);
    atomicMax(next.groups[0], (first + 4u + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x);
}

void main() {
    if (gl_GlobalInvocationID.x >= min(queue.count, uint(queue.pieces.length()))) return;
    const uvec2 piece = queue.pieces[gl_GlobalInvocationID.x];
    const PatchShape shape = loadShape(piece.x);
    if (!isDrawn(shape)) return;
    loadControlPoints(shape, lattice);
    float extent = 0.0;
    for (int i = 0; i < 10; ++i) {
        control[i] = toGrid(lattice[i]);
        extent = max(extent, max(abs(control[i].x), abs(control[i].y)));
    }
    exact = extent > kExactBeyond;
    bend = patchBend(control);

    const uint level = pieceDepth(piece.y), path = piece.y & 0x0fffffffu;
    vec2 corners[3], b[3], lo, hi;
    locate(level, path, corners, b, lo, hi);
    if (!inView(lo, hi)) return;
    if (level < kLastDepth && any(greaterThan(hi - lo, vec2(kSmall))))
        handOn(piece.x, level, path);
    else
        subdivide(piece.x, level, path);
}
