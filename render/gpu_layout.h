// What lies in the GPU's buffers: shaders/include/gpu_layout.glsl is the same in GLSL, where the comments
// are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace tessera::render {

// Texture units of the buffers that are read, in all programs.
enum class Unit : uint32_t {
    Visibility,
    Edges,
    Patches,
    Terms,
    ReachLists,
    Reaches,
    Features,
    EdgeLevels,
    Pieces,
    Rects
};
constexpr uint32_t kUnitCount = 10;
// Storage buffers that the compute passes write, and the counters of the resolve pass.
enum class Binding : uint32_t { EdgeLevels = 0, Pieces = 1, Draws = 2, Counters = 0 };
constexpr uint32_t kBindingCount = 3;

struct GpuEdge {
    std::array<glm::ivec2, 4> p;
};
static_assert(sizeof(GpuEdge) == 2 * 16);

constexpr uint32_t kGpuDrawn = 1, kGpuAffine = 2, kGpuHidden = 4;

struct GpuPatch {
    std::array<uint32_t, 3> sides;
    uint32_t flags;
    glm::ivec2 interior;
    uint32_t firstTerm;
    uint32_t terms;  // count in the lower half, those of the other channels in the upper
    std::array<glm::vec4, 3> polynomial;
};
static_assert(sizeof(GpuPatch) == 5 * 16);

struct GpuTerm {
    glm::vec2 centre;
    std::array<float, 4> alpha;
    std::array<float, 2> padding;
};
static_assert(sizeof(GpuTerm) == 2 * 16);

struct GpuReachList {
    uint32_t first;
    uint32_t count;
};
static_assert(sizeof(GpuReachList) == 8);

constexpr uint32_t kGpuReachFromLeft = 0x40000000, kGpuReachFromRight = 0x80000000;

constexpr uint32_t kGpuEven = 1, kGpuFadesAtBegin = 2, kGpuFadesAtEnd = 4;
constexpr uint32_t kGpuSideShift = 3;
constexpr size_t kGpuFeatureSegments = 8;

struct GpuFeature {
    std::array<glm::ivec2, 2> ends;
    std::array<glm::ivec2, 2> inner;
    float bend;
    float flatness;
    float reach;
    float chainLength;
    std::array<float, 2> sigma;
    std::array<uint32_t, 2> patches;
    std::array<glm::vec2, 2> endTangents;
    uint32_t chain;
    uint32_t flags;
    uint32_t padding;
    std::array<float, kGpuFeatureSegments + 1> arc;
    std::array<glm::vec2, kGpuFeatureSegments> chords;
};
static_assert(sizeof(GpuFeature) == 12 * 16);

struct GpuPiece {
    uint32_t patchId;
    uint32_t code;
};
static_assert(sizeof(GpuPiece) == 8);

// DrawArraysIndirectCommand.
struct GpuDrawCommand {
    uint32_t count;
    uint32_t instanceCount;
    uint32_t first;
    uint32_t baseInstance;
};
static_assert(sizeof(GpuDrawCommand) == 16);

struct GpuView {
    glm::ivec2 origin;
    glm::vec2 fraction;
    glm::vec2 gridPerUnit;
    glm::vec2 gridSize;
    glm::ivec2 target;
    float edgeTolerance;
    float insideTolerance;
    uint32_t patchCount;
    uint32_t edgeCount;
    uint32_t opponent;
    uint32_t channels;
    uint32_t pieceCapacity;
    uint32_t drawVertices;
    uint32_t drawCount;
    uint32_t showHidden;
    std::array<uint32_t, 4> padding;
};
static_assert(sizeof(GpuView) == 96);

constexpr uint32_t kGpuNoPatch = 0xffffffff;

}  // namespace tessera::render
