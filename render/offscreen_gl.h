// An OpenGL context without a window or an X server: EGL's surfaceless platform, or its default display.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"

namespace tessera::render {

// A context of OpenGL 4.5 core, current on the thread that created it until it is destroyed.
class OffscreenGl {
  public:
    // Internal where the machine has no EGL or no OpenGL 4.5: the caller draws with the CPU renderer.
    static Result<OffscreenGl> create();

    OffscreenGl(OffscreenGl&&) noexcept;
    OffscreenGl& operator=(OffscreenGl&&) noexcept;
    ~OffscreenGl();

  private:
    struct State;
    explicit OffscreenGl(std::unique_ptr<State> state);

    std::unique_ptr<State> mState;
};

// What draws in the current context.
struct GlDevice {
    std::string name;       // GL_RENDERER
    std::string version;    // GL_VERSION
    bool software = false;  // no graphics hardware: the CPU renderer is faster
};
GlDevice currentDevice();

// Internal, with a sentence that says what is missing, unless the current context has all that Renderer
// needs.
Result<void> checkCurrentContext();

// Whether what has been drawn since the last call is there: Internal, with a sentence that says why not,
// where the context was lost or memory ran out. Nothing will be drawn from then on.
Result<void> checkDrawn();

}  // namespace tessera::render
