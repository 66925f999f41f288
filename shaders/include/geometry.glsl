// Bezier curves and triangles relative to the view (core/mesh/bezier.h has the order of control points).

// A lattice point in samples from the view's upper left corner. The difference of the integers is exact, so
// that what is in view keeps its precision at any zoom.
vec2 toGrid(ivec2 p) {
    return (vec2(p - view.origin) - view.fraction) * view.gridPerUnit;
}
dvec2 toGridExact(ivec2 p) {
    return (dvec2(p - view.origin) - dvec2(view.fraction)) * dvec2(view.gridPerUnit);
}

void loadControlPoints(PatchShape shape, out ivec2 control[10]) {
    for (int s = 0; s < 3; ++s) {
        const uint halfedge = shape.sides[s];
        ivec2 p[4];
        loadEdge(halfedge >> 1, p);
        const bool along = (halfedge & 1u) == 0u;
        control[3 * s] = along ? p[0] : p[3];
        control[3 * s + 1] = along ? p[1] : p[2];
        control[3 * s + 2] = along ? p[2] : p[1];
    }
    control[9] = shape.interior;
}

// Neither single precision nor an estimate of it in samples is worth much beyond this many samples.
const float kExactBeyond = 16384.0;

// The largest of the second differences of a curve: it is within 3/4 of that over n^2 of its n chords.
float curveBend(vec2 p[4]) {
    return max(length(p[0] - 2.0 * p[1] + p[2]), length(p[1] - 2.0 * p[2] + p[3]));
}

vec2 curvePoint(vec2 p[4], float t) {
    precise const float s = 1.0 - t;
    precise const vec2 point =
        s * s * s * p[0] + 3.0 * s * s * t * p[1] + 3.0 * s * t * t * p[2] + t * t * t * p[3];
    return point;
}
dvec2 curvePoint(dvec2 p[4], double t) {
    precise const double s = 1.0LF - t;
    precise const dvec2 point =
        s * s * s * p[0] + 3.0LF * s * s * t * p[1] + 3.0LF * s * t * t * p[2] + t * t * t * p[3];
    return point;
}

// The largest of the second differences of a patch along the three directions of its domain.
float patchBend(vec2 b[10]) {
    float bend = 0.0;
    for (int s = 0; s < 3; ++s)
        bend = max(bend, curveBend(vec2[4](b[3 * s], b[3 * s + 1], b[3 * s + 2], b[(3 * s + 3) % 9])));
    bend = max(bend, length(b[8] - 2.0 * b[9] + b[4]));
    bend = max(bend, length(b[2] - 2.0 * b[9] + b[7]));
    return max(bend, length(b[1] - 2.0 * b[9] + b[5]));
}

vec2 patchPoint(vec2 p[10], vec2 vw) {
    const float v = vw.x, w = vw.y, u = 1.0 - v - w;
    return u * u * (u * p[0] + 3.0 * (v * p[1] + w * p[8])) + v * v * (v * p[3] + 3.0 * (u * p[2] + w * p[4])) +
           w * w * (w * p[6] + 3.0 * (v * p[5] + u * p[7])) + 6.0 * u * v * w * p[9];
}
dvec2 patchPoint(dvec2 p[10], dvec2 vw) {
    precise const double v = vw.x, w = vw.y, u = 1.0LF - v - w;
    precise const dvec2 point = u * u * (u * p[0] + 3.0LF * (v * p[1] + w * p[8])) +
                                v * v * (v * p[3] + 3.0LF * (u * p[2] + w * p[4])) +
                                w * w * (w * p[6] + 3.0LF * (v * p[5] + u * p[7])) + 6.0LF * u * v * w * p[9];
    return point;
}

const uint kMaxDepth = 6u;        // of presplitting
const uint kMaxLevelBits = 12u;   // an edge has at most 2^12 segments: 64 for each of 2^6 pieces
const uint kTessellatorBits = 6u; // the level that every implementation has

// The power of two of segments that keep a curve or map of this bend within the tolerance.
uint levelBits(float bend, float tolerance) {
    const float squared = 0.75 * bend / tolerance;  // of the segments
    return uint(clamp(ceil(0.5 * log2(max(squared, 1.0))), 0.0, float(kMaxLevelBits)));
}

uint pieceDepth(uint code) {
    return code >> 28;
}
// The parameters (v, w) of a piece's corners: multiples of 2^-depth, exactly.
void pieceCorners(uint depth, uint path, out vec2 corners[3]) {
    corners[0] = vec2(0.0, 0.0);
    corners[1] = vec2(1.0, 0.0);
    corners[2] = vec2(0.0, 1.0);
    for (uint level = depth; level > 0u; --level) {
        const uint child = (path >> (2u * (level - 1u))) & 3u;
        const vec2 ab = 0.5 * (corners[0] + corners[1]), bc = 0.5 * (corners[1] + corners[2]),
                   ca = 0.5 * (corners[2] + corners[0]);
        if (child == 0u) {
            corners[1] = ab;
            corners[2] = ca;
        } else if (child == 1u) {
            corners[0] = ab;
            corners[2] = bc;
        } else if (child == 2u) {
            corners[0] = ca;
            corners[1] = bc;
        } else {
            corners[0] = ab;
            corners[1] = bc;
            corners[2] = ca;
        }
    }
}
