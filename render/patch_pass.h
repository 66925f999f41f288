// The visibility buffer: for each sample of the view the patch that is seen there and its parameters, by
// hardware tessellation.
#pragma once

#include "core/base/result.h"
#include "render/gl_objects.h"
#include "render/lod_pass.h"

namespace tessera::render {

// RG32UI, rows from the top: the patch's id or kGpuNoPatch, and v, w as two 16 bit fractions.
class VisibilityBuffer {
  public:
    VisibilityBuffer() : mFramebuffer(makeFramebuffer()) {}

    void resize(int width, int height);
    // Makes it the framebuffer that is drawn to, without a patch anywhere.
    void begin() const;
    const Texture& texture() const { return mTexture; }
    int width() const { return mWidth; }
    int height() const { return mHeight; }

  private:
    Texture mTexture{GL_RG32UI};
    Framebuffer mFramebuffer;
    int mWidth = 0, mHeight = 0;  // of the part of the texture that is drawn to
};

class PatchPass {
  public:
    static Result<PatchPass> create();

    // Draws the pieces that a LodPass left into the bound visibility buffer.
    void run(const PieceDraws& draws) const;

  private:
    Program mProgram;
};

}  // namespace tessera::render
