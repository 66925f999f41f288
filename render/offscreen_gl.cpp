// See offscreen_gl.h.
#include "render/offscreen_gl.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstring>
#include <utility>

#include "render/gl.h"

namespace tessera::render {

namespace {

constexpr int kMajor = 4, kMinor = 5;

tl::unexpected<Error> unavailable(const std::string& why) {
    return failure(ErrorCode::Internal,
                   "OpenGL 4.5 is not available: " + why + "; draw with the CPU instead");
}

bool offers(const char* extensions, const char* name) {
    const size_t length = std::strlen(name);
    for (const char* at = extensions; at && (at = std::strstr(at, name)); at += length)
        if ((at == extensions || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0)) return true;
    return false;
}

// With a device of its own where the driver offers one (no display server is asked for), else Mesa's
// surfaceless platform, else the default display.
EGLDisplay openDisplay() {
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const auto initialized = [](EGLDisplay display) {
        return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
    };
    if (offers(extensions, "EGL_EXT_platform_device") && offers(extensions, "EGL_EXT_device_enumeration")) {
        // The function of EGL_EXT_device_enumeration has no symbol of its own.
        const auto queryDevices =
            reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (queryDevices && queryDevices(EGLint(devices.size()), devices.data(), &count) == EGL_TRUE)
            for (size_t i = 0; i < size_t(count); ++i) {
                const EGLDisplay display =
                    eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
                if (initialized(display)) return display;
            }
    }
    if (offers(extensions, "EGL_MESA_platform_surfaceless")) {
        const EGLDisplay display =
            eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (initialized(display)) return display;
    }
    const EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    return initialized(display) ? display : EGL_NO_DISPLAY;
}

std::string text(GLenum name) {
    const auto* bytes = reinterpret_cast<const char*>(glGetString(name));
    return bytes ? bytes : "";
}

GLint integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

}  // namespace

struct OffscreenGl::State {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;

    // The display stays initialized: EGL gives one handle to all who ask, and others may use it.
    ~State() {
        if (context == EGL_NO_CONTEXT) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
    }
};

OffscreenGl::OffscreenGl(std::unique_ptr<State> state) : mState(std::move(state)) {}
OffscreenGl::OffscreenGl(OffscreenGl&&) noexcept = default;
OffscreenGl& OffscreenGl::operator=(OffscreenGl&&) noexcept = default;
OffscreenGl::~OffscreenGl() = default;

Result<OffscreenGl> OffscreenGl::create() {
    auto state = std::make_unique<State>();
    state->display = openDisplay();
    if (state->display == EGL_NO_DISPLAY) return unavailable("EGL has no display on this machine");
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return unavailable("EGL knows only OpenGL ES");
    constexpr std::array<EGLint, 5> kConfig{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                            EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(state->display, kConfig.data(), &config, 1, &count) != EGL_TRUE || count == 0)
        return unavailable("EGL has no configuration for it");
    constexpr std::array<EGLint, 7> kContext{EGL_CONTEXT_MAJOR_VERSION,
                                             kMajor,
                                             EGL_CONTEXT_MINOR_VERSION,
                                             kMinor,
                                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                             EGL_NONE};
    state->context = eglCreateContext(state->display, config, EGL_NO_CONTEXT, kContext.data());
    if (state->context == EGL_NO_CONTEXT) return unavailable("the driver offers an older version");
    if (eglMakeCurrent(state->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state->context) != EGL_TRUE)
        return unavailable("the driver cannot draw without a window");
    if (const auto fit = checkCurrentContext(); !fit) return tl::unexpected(fit.error());
    return OffscreenGl(std::move(state));
}

GlDevice currentDevice() {
    GlDevice device{text(GL_RENDERER), text(GL_VERSION), false};
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software Rasterizer"})
        device.software = device.software || device.name.find(name) != std::string::npos;
    return device;
}

Result<void> checkCurrentContext() {
    const int major = integer(GL_MAJOR_VERSION), minor = integer(GL_MINOR_VERSION);
    if (major < kMajor || (major == kMajor && minor < kMinor))
        return unavailable("the context has version " + std::to_string(major) + "." + std::to_string(minor));
    // A mesh of a million patches with sixteen terms each; the standard asks for less.
    constexpr int kTexels = 1 << 25;
    if (integer(GL_MAX_TEXTURE_BUFFER_SIZE) < kTexels)
        return unavailable("the driver's texture buffers are too small");
    return {};
}

Result<void> checkDrawn() {
    if (glGetGraphicsResetStatus() != GL_NO_ERROR)
        return failure(ErrorCode::Internal, "the graphics card was reset");
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return {};
    if (error == GL_OUT_OF_MEMORY)
        return failure(ErrorCode::Internal, "the graphics card has too little memory");
    if (error == GL_CONTEXT_LOST) return failure(ErrorCode::Internal, "the OpenGL context was lost");
    return failure(ErrorCode::Internal, "the OpenGL driver reports error " + std::to_string(error));
}

}  // namespace tessera::render
