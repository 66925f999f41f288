// Colours from the visibility buffer, blur and averaging of samples included.
#pragma once

#include <cstdint>
#include <map>

#include "core/base/result.h"
#include "render/gl_objects.h"

namespace tessera::render {

// How many splines were evaluated for a frame.
struct EvaluationCounts {
    uint32_t colours = 0;  // one for each patch that a pixel's samples are of
    uint32_t blur = 0;     // more of them where features are blurred
};

class ResolvePass {
  public:
    static Result<ResolvePass> create();

    // Draws over the bound framebuffer's viewport; `samples` is 1 or 4. The textures and buffers are bound.
    void run(int samples) const;
    // The same, counted. Compiles a program at the first call.
    Result<EvaluationCounts> runCounted(int samples);

  private:
    static Result<Program> makeVariant(int samples, bool counted);

    std::map<int, Program> mPrograms;  // by samples
    std::map<int, Program> mCountedPrograms;
};

}  // namespace tessera::render
