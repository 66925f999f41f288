// What lies in the buffers. render/gpu_layout.h is the same in C++; a test compares the offsets.

// A cubic in lattice coordinates (1/256 image pixel), in the direction of the edge's first halfedge.
struct Edge {
    ivec2 p[4];
};

const uint kDrawn = 1u;   // the patch exists and is not hidden
const uint kAffine = 2u;  // its control points are those of a straight triangle
const uint kCutOut = 4u;  // it is transparent

struct Patch {
    uint sides[3];  // halfedges: edge << 1 | 1 where it runs against the edge
    uint flags;
    ivec2 interior;
    uint firstTerm;
    uint terms;  // those of channel 0 or more; in the upper half those of the longest other channel
    vec4 polynomial[3];  // b0, b1, b2 by channel
};

// phi around one centre, by channel.
struct Term {
    vec2 centre;
    float alpha[4];
};

// Features within reach of a patch: their part of `reaches`.
struct ReachList {
    uint first;
    uint count;
};

const uint kReachFromLeft = 0x40000000u, kReachFromRight = 0x80000000u, kReachFeature = 0x3fffffffu;

const uint kEven = 1u;          // t is nearly the share of the base
const uint kSideShift = 2u;     // two bits each: which side of its left, its right patch the edge is
const int kFeatureSegments = 8;

// EdgeBlur::Feature; lengths in image pixels.
struct Feature {
    ivec2 p[4];  // lattice
    vec2 endTangents[2];
    float sigma[2];
    uint patches[2];
    float bend;
    float flatness;
    uint chain;
    uint flags;
    vec2 chords[9];  // the curve's points at t = i / 8, from p[0]
    float arc[9];
};

const uint kFadesAtBegin = 1u, kFadesAtEnd = 2u;

struct Chain {
    float length;
    float reach;
    uint fades;
};

// A part of a patch to be tessellated: `code` holds the depth in its upper 4 bits and for each level the child
// of the 4-way subdivision in 2 bits, the last level lowest.
struct Piece {
    uint patchId;
    uint code;
};

// DrawArraysIndirectCommand.
struct DrawCommand {
    uint count;
    uint instanceCount;
    uint first;
    uint baseInstance;
};

layout(std140, binding = 0) uniform ViewBlock {
    ivec2 origin;       // lattice: the last point at or before the view's upper left corner
    vec2 fraction;      // lattice units from there to the corner
    vec2 gridPerUnit;   // grid points (samples) per lattice unit
    vec2 gridSize;      // of the view, in samples
    ivec2 target;       // lower left pixel of the view in the framebuffer
    float edgeTolerance;    // samples: how far an edge may be from its chords
    float insideTolerance;  // samples: how far the map inside a patch may be from its triangles'
    uint patchCount;
    uint edgeCount;
    uint opponent;      // colour basis
    uint channels;
    uint pieceCapacity;   // of a draw
    uint drawVertices;    // about as many are tessellated in a draw; 0: one draw does it all
    uint drawCount;
    float sharpen;      // 0: no blur
}
view;

const uint kNoPatch = 0xffffffffu;
