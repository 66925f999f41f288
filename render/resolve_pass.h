// Colours from the visibility buffer, blur and averaging of samples included.
#pragma once

#include <cstdint>
#include <map>

#include "core/base/result.h"
#include "render/blur_tiles.h"
#include "render/gl_objects.h"
#include "render/mirror_buffer.h"

namespace tessera::render {

// How many splines were evaluated for a frame.
struct EvaluationCounts {
    uint32_t colours = 0;  // one for each patch that a pixel's samples are of
    uint32_t blur = 0;     // more of them where features are blurred
};

class ResolvePass {
  public:
    static Result<ResolvePass> create();

    // Draws the view's `tiles` into the bound framebuffer's viewport, which is as large; `samples` is 1 or 4.
    // The textures and buffers are bound.
    void run(const BlurTiles& tiles, glm::ivec2 size, int samples);
    // The same, counted. Compiles programs at the first call.
    Result<EvaluationCounts> runCounted(const BlurTiles& tiles, glm::ivec2 size, int samples);

  private:
    struct Variants {
        Program plain, blurred;
    };
    static Result<Variants> makeVariants(int samples, bool counted);
    void draw(const Variants& programs, const BlurTiles& tiles, glm::ivec2 size);

    std::map<int, Variants> mPrograms;  // by samples
    std::map<int, Variants> mCountedPrograms;
    MirrorBuffer<glm::ivec4> mRects{GL_RGBA32I};
};

}  // namespace tessera::render
