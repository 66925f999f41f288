// Level of detail: which patches are seen, in which pieces, and in how many segments each edge is drawn.
#pragma once

#include "core/base/result.h"
#include "render/gl_objects.h"
#include "render/gpu_layout.h"

namespace tessera::render {

// Indirect draws of pieces as patches of one vertex: `count` commands from byte `offset` on.
struct PieceDraws {
    GLuint commands = 0;
    GLintptr offset = 0;
    GLsizei count = 0;
};

class LodPass {
  public:
    // Needs the context, whose device it asks for.
    static Result<LodPass> create();

    // Sets what the view block says of draws, for a mesh of so many patches.
    void plan(GpuView& view) const;
    // Fills the buffers of pieces, levels and draws for the bound mesh and view, and leaves them bound.
    PieceDraws run(const GpuView& view);

    // By edge id, as bits: 2^bits segments.
    const Buffer& edgeLevels() const { return mEdgeLevels; }

  private:
    Program mEdgeProgram, mPatchProgram;
    bool mManyDraws = false;
    Buffer mEdgeLevels{GL_R32UI}, mPieces{GL_RG32UI}, mDraws;
};

}  // namespace tessera::render
