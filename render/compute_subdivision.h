// The visibility buffer by the paper's own 4-way subdivision (section 5), in a compute shader: slower than
// the tessellator, and simpler, to compare it with.
#pragma once

#include <array>

#include "core/base/result.h"
#include "render/gl_objects.h"

namespace tessera::render {

class ComputeSubdivision {
  public:
    static Result<ComputeSubdivision> create();

    // Writes the bound mesh's patches into a cleared visibility buffer. Up to one sample in ten thousand
    // falls into a crack between pieces of different depths and stays as it was.
    void run(const Texture& visibility, size_t patchCount);

  private:
    Program mProgram;
    std::array<Buffer, 2> mQueues;
};

}  // namespace tessera::render
