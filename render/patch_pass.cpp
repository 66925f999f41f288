// See patch_pass.h.
#include "render/patch_pass.h"

#include <array>

#include "render/gpu_layout.h"
#include "render/shader_library.h"

namespace tessera::render {

void VisibilityBuffer::resize(int width, int height) {
    mWidth = width;
    mHeight = height;
    if (mTexture.reserve(width, height))
        glNamedFramebufferTexture(mFramebuffer.name(), GL_COLOR_ATTACHMENT0, mTexture.name(), 0);
}

void VisibilityBuffer::begin() const {
    glBindFramebuffer(GL_FRAMEBUFFER, mFramebuffer.name());
    glViewport(0, 0, width(), height());
    constexpr std::array<GLuint, 4> kNothing{kGpuNoPatch, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, kNothing.data());
}

Result<PatchPass> PatchPass::create() {
    auto program =
        makeProgram(std::array<std::string_view, 4>{"patch.vert", "patch.tesc", "patch.tese", "patch.frag"});
    if (!program) return tl::unexpected(program.error());
    PatchPass pass;
    pass.mProgram = std::move(*program);
    return pass;
}

void PatchPass::run(const PieceDraws& draws) const {
    glUseProgram(mProgram.name());
    glPatchParameteri(GL_PATCH_VERTICES, 1);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, draws.commands);
    const auto* first = reinterpret_cast<const void*>(draws.offset);  // OpenGL's way to say so
    glMultiDrawArraysIndirect(GL_PATCHES, first, draws.count, 0);
}

}  // namespace tessera::render
