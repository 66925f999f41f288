// See lod_pass.h.
#include "render/lod_pass.h"

#include <array>
#include <vector>

#include "render/offscreen_gl.h"
#include "render/shader_library.h"

namespace tessera::render {

namespace {

constexpr size_t kGroupSize = 64;  // local_size_x

// Mesa's software pipeline counts the tessellated vertices of a draw in 16 bits.
constexpr uint32_t kDrawVertices = 8192, kDrawPieces = 256, kMostDraws = 1024;

// Pieces of presplit patches: few are seen at a time.
constexpr uint32_t kPresplitPieces = 1 << 16;

// The counter of vertices, then the commands; the shader's buffer is laid out so.
constexpr size_t kCommandsOffset = sizeof(uint32_t);

GLuint groups(size_t count) {
    return GLuint((count + kGroupSize - 1) / kGroupSize);
}

}  // namespace

Result<LodPass> LodPass::create() {
    LodPass pass;
    for (auto [program, name] : {std::pair{&pass.mEdgeProgram, "lod_edges.comp"},
                                 std::pair{&pass.mPatchProgram, "lod_patches.comp"}}) {
        auto made = makeProgram(std::array<std::string_view, 1>{name});
        if (!made) return tl::unexpected(made.error());
        *program = std::move(*made);
    }
    pass.mManyDraws = currentDevice().software;
    return pass;
}

void LodPass::plan(GpuView& view) const {
    view.drawVertices = mManyDraws ? kDrawVertices : 0;
    view.pieceCapacity = mManyDraws ? kDrawPieces : view.patchCount + kPresplitPieces;
    view.drawCount = mManyDraws ? kMostDraws : 1;
}

PieceDraws LodPass::run(const GpuView& view) {
    mEdgeLevels.reserve(view.edgeCount * sizeof(uint32_t));
    mPieces.reserve(size_t(view.pieceCapacity) * view.drawCount * sizeof(GpuPiece));
    std::vector<GpuDrawCommand> commands;
    for (uint32_t i = 0; i < view.drawCount; ++i) commands.push_back({0, 1, i * view.pieceCapacity, 0});
    const size_t bytes = commands.size() * sizeof(GpuDrawCommand);
    mDraws.reserve(kCommandsOffset + bytes);
    constexpr uint32_t kNoVertices = 0;
    mDraws.write(0, &kNoVertices, sizeof(kNoVertices));
    mDraws.write(kCommandsOffset, commands.data(), bytes);
    mEdgeLevels.bindStorage(Binding::EdgeLevels);
    mPieces.bindStorage(Binding::Pieces);
    mDraws.bindStorage(Binding::Draws);
    mEdgeLevels.bindTexels(Unit::EdgeLevels);
    mPieces.bindTexels(Unit::Pieces);
    glUseProgram(mEdgeProgram.name());
    glDispatchCompute(groups(view.edgeCount), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glUseProgram(mPatchProgram.name());
    glDispatchCompute(groups(view.patchCount), 1, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    return {mDraws.name(), GLintptr(kCommandsOffset), GLsizei(view.drawCount)};
}

}  // namespace tessera::render
