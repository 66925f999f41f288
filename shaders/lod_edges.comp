#version 450 core
// How many segments each edge is drawn with: a function of its curve alone, so that it is the same from both
// sides.
#include "include/gpu_layout.glsl"
#include "include/geometry.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer EdgeLevelBuffer { uint edgeLevels[]; };  // in bits

void main() {
    const uint e = gl_GlobalInvocationID.x;
    if (e >= view.edgeCount) return;
    ivec2 lattice[4];
    loadEdge(e, lattice);
    vec2 p[4];
    for (int i = 0; i < 4; ++i) p[i] = toGrid(lattice[i]);
    const vec2 lo = min(min(p[0], p[1]), min(p[2], p[3])), hi = max(max(p[0], p[1]), max(p[2], p[3]));
    // Out of view a chord is as good as its curve.
    const bool seen = all(lessThan(lo, view.gridSize)) && all(greaterThan(hi, vec2(0.0)));
    edgeLevels[e] = seen ? levelBits(curveBend(p), view.edgeTolerance) : 0u;
}
