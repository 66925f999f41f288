#version 450 core
// Positions of the tessellated points. One on a patch's side comes from the edge's curve in the edge's own
// direction, so that both patches beside it get the same bits.
#include "include/gpu_layout.glsl"
#include "include/geometry.glsl"

layout(triangles, equal_spacing, ccw) in;

patch in uint tPatch;
patch in uint tExact;
patch in uvec3 tSides;
patch in vec3 tLevels;
patch in vec2 tCorners[3];
patch in vec2 tControl[10];

flat out uint fPatch;
out vec2 fParameters;

// The nearest of the level's even steps: on a side the levels are powers of two, so that this is exact.
float step_(float at, float level) {
    return round(at * level) / level;
}

vec2 edgePoint(uint halfedge, float t) {
    const uint e = halfedge >> 1;
    const float along = (halfedge & 1u) == 0u ? t : 1.0 - t;  // exact
    ivec2 lattice[4];
    loadEdge(e, lattice);
    vec2 p[4];
    float extent = 0.0;
    for (int i = 0; i < 4; ++i) {
        p[i] = toGrid(lattice[i]);
        extent = max(extent, max(abs(p[i].x), abs(p[i].y)));
    }
    // The ends are vertices, which several edges share.
    if (along == 0.0) return p[0];
    if (along == 1.0) return p[3];
    if (extent <= kExactBeyond) return curvePoint(p, along);
    dvec2 exact[4];
    for (int i = 0; i < 4; ++i) exact[i] = toGridExact(lattice[i]);
    return vec2(curvePoint(exact, double(along)));
}

vec2 insidePoint(vec2 at) {
    if (tExact == 0u) {
        vec2 control[10];
        for (int i = 0; i < 10; ++i) control[i] = tControl[i];
        return patchPoint(control, at);
    }
    ivec2 lattice[10];
    loadControlPoints(loadShape(tPatch), lattice);
    dvec2 control[10];
    for (int i = 0; i < 10; ++i) control[i] = toGridExact(lattice[i]);
    return vec2(patchPoint(control, dvec2(at)));
}

void main() {
    vec3 c = gl_TessCoord;
    if (c.z == 0.0) {
        c.y = step_(c.y, tLevels[0]);
        c.x = 1.0 - c.y;
    } else if (c.x == 0.0) {
        c.z = step_(c.z, tLevels[1]);
        c.y = 1.0 - c.z;
    } else if (c.y == 0.0) {
        c.x = step_(c.x, tLevels[2]);
        c.z = 1.0 - c.x;
    }
    // Dyadic on the sides of a piece: exact there.
    const vec2 at = c.x * tCorners[0] + c.y * tCorners[1] + c.z * tCorners[2];
    const vec2 position = at.y == 0.0           ? edgePoint(tSides[0], at.x)
                          : at.x + at.y == 1.0  ? edgePoint(tSides[1], at.y)
                          : at.x == 0.0         ? edgePoint(tSides[2], 1.0 - at.y)
                                                : insidePoint(at);
    fPatch = tPatch;
    fParameters = at;
    gl_Position = vec4(2.0 * position / view.gridSize - 1.0, 0.0, 1.0);
}
