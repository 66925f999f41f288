// What lies in the buffers, and how it is read: as texels, since all stages of all drivers have texture buffers.
// render/gpu_layout.h is the same in C++; a test reads what was written there through these functions.

layout(std140, binding = 0) uniform ViewBlock {
    ivec2 origin;         // lattice: the last point at or before the view's upper left corner
    vec2 fraction;        // lattice units from there to the corner
    vec2 gridPerUnit;     // grid points (samples) per lattice unit
    vec2 gridSize;        // of the view, in samples
    ivec2 target;         // lower left pixel of the view in the framebuffer
    float edgeTolerance;    // samples: how far an edge may be from its chords
    float insideTolerance;  // samples: how far the map inside a patch may be from its triangles'
    uint patchCount;
    uint edgeCount;
    uint opponent;        // colour basis
    uint channels;
    uint pieceCapacity;   // of a draw
    uint drawVertices;    // about as many are tessellated in a draw; 0: one draw does it all
    uint drawCount;
    uint showHidden;
}
view;

layout(binding = 1) uniform isamplerBuffer edgeTexels;
layout(binding = 2) uniform usamplerBuffer patchTexels;
layout(binding = 3) uniform samplerBuffer termTexels;
layout(binding = 4) uniform usamplerBuffer reachListTexels;
layout(binding = 5) uniform usamplerBuffer reachTexels;
layout(binding = 6) uniform usamplerBuffer featureTexels;
layout(binding = 7) uniform usamplerBuffer edgeLevelTexels;
layout(binding = 8) uniform usamplerBuffer pieceTexels;
layout(binding = 9) uniform isamplerBuffer rectTexels;

const uint kNoPatch = 0xffffffffu;

// A cubic in lattice coordinates (1/256 image pixel), in the direction of the edge's first halfedge.
void loadEdge(uint e, out ivec2 p[4]) {
    const ivec4 first = texelFetch(edgeTexels, int(2u * e)), second = texelFetch(edgeTexels, int(2u * e + 1u));
    p[0] = first.xy;
    p[1] = first.zw;
    p[2] = second.xy;
    p[3] = second.zw;
}

const uint kDrawn = 1u;   // the patch exists and is not cut out
const uint kAffine = 2u;  // its control points are those of a straight triangle
const uint kHidden = 4u;

struct PatchShape {
    uvec3 sides;  // halfedges: edge << 1 | 1 where it runs against the edge
    uint flags;
    ivec2 interior;
};
PatchShape loadShape(uint p) {
    const uvec4 first = texelFetch(patchTexels, int(5u * p)), second = texelFetch(patchTexels, int(5u * p + 1u));
    return PatchShape(first.xyz, first.w, ivec2(second.xy));
}
bool isDrawn(PatchShape shape) {
    return (shape.flags & kDrawn) != 0u && ((shape.flags & kHidden) == 0u || view.showHidden != 0u);
}

// A spline's terms: those of channel 0 or more, of which the first `others` have the other channels.
struct SplineTerms {
    uint first;
    uint count;
    uint others;
};
SplineTerms loadTerms(uint p) {
    const uvec4 texel = texelFetch(patchTexels, int(5u * p + 1u));
    return SplineTerms(texel.z, texel.w & 0xffffu, texel.w >> 16);
}
// b0, b1 or b2, by channel.
vec4 loadPolynomial(uint p, uint i) {
    return uintBitsToFloat(texelFetch(patchTexels, int(5u * p + 2u + i)));
}

// The centre, and the alphas of channels 0 and 1.
vec4 loadTerm(uint term) {
    return texelFetch(termTexels, int(2u * term));
}
// The alphas of channels 2 and 3.
vec2 loadTermRest(uint term) {
    return texelFetch(termTexels, int(2u * term + 1u)).xy;
}

// The features within reach of a patch: where they begin among the reaches, and how many.
uvec2 loadReachList(uint p) {
    return texelFetch(reachListTexels, int(p)).xy;
}
const uint kReachFromLeft = 0x40000000u, kReachFromRight = 0x80000000u, kReachFeature = 0x3fffffffu;
uint loadReach(uint i) {
    return texelFetch(reachTexels, int(i)).x;
}

// EdgeBlur::Feature and its chain; lengths in image pixels.
const uint kEven = 1u;            // t is nearly the share of the base
const uint kFadesAtBegin = 2u, kFadesAtEnd = 4u;
const uint kSideShift = 3u;       // two bits each: which side of its left, its right patch the edge is
const int kFeatureSegments = 8;

uvec4 featureTexel(uint f, uint i) {
    return texelFetch(featureTexels, int(12u * f + i));
}
// The ends of the curve, lattice.
ivec4 loadFeatureEnds(uint f) {
    return ivec4(featureTexel(f, 0u));
}
// The inner control points of the curve, lattice.
ivec4 loadFeatureInner(uint f) {
    return ivec4(featureTexel(f, 1u));
}
struct FeatureBounds {
    float bend;      // the curve's distance from the line between its ends, at most
    float flatness;  // from the chords
    float reach;     // of the chain
    float chainLength;
};
FeatureBounds loadFeatureBounds(uint f) {
    const vec4 texel = uintBitsToFloat(featureTexel(f, 2u));
    return FeatureBounds(texel.x, texel.y, texel.z, texel.w);
}
// At both ends.
vec2 loadFeatureSigma(uint f) {
    return uintBitsToFloat(featureTexel(f, 3u).xy);
}
// Left and right.
uvec2 loadFeaturePatches(uint f) {
    return featureTexel(f, 3u).zw;
}
vec4 loadFeatureEndTangents(uint f) {
    return uintBitsToFloat(featureTexel(f, 4u));
}
uint loadFeatureChain(uint f) {
    return featureTexel(f, 5u).x;
}
uint loadFeatureFlags(uint f) {
    return featureTexel(f, 5u).y;
}
// Arc length along the chain at t = i / 8.
float loadFeatureArc(uint f, int i) {
    return uintBitsToFloat(featureTexel(f, 5u + uint(i + 3) / 4u)[(i + 3) & 3]);
}
// The curve's points at t = (2 i + 1) / 8 and (2 i + 2) / 8, from its first control point; i < 4.
vec4 loadFeatureChords(uint f, int i) {
    return uintBitsToFloat(featureTexel(f, 8u + uint(i)));
}

// How many segments an edge is drawn with, as a power of two.
uint loadEdgeLevel(uint e) {
    return texelFetch(edgeLevelTexels, int(e)).x;
}

// A part of a patch to be tessellated: `code` holds the depth in its upper 4 bits and for each level the child
// of the 4-way subdivision in 2 bits, the last level lowest.
struct Piece {
    uint patchId;
    uint code;
};
Piece loadPiece(uint i) {
    const uvec2 texel = texelFetch(pieceTexels, int(i)).xy;
    return Piece(texel.x, texel.y);
}
