// OpenGL objects that are deleted with their owners. All calls need the context that made them to be current;
// names are 0 once moved from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/image/image.h"
#include "render/gl.h"
#include "render/gpu_layout.h"

namespace tessera::render {

// A name that `Delete` gives back.
template <void (*Delete)(GLuint)>
class GlObject {
  public:
    GlObject() = default;
    explicit GlObject(GLuint name) : mName(name) {}
    GlObject(GlObject&& other) noexcept : mName(std::exchange(other.mName, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(mName, other.mName);
        return *this;
    }
    ~GlObject() {
        if (mName != 0) Delete(mName);
    }

    GLuint name() const { return mName; }

  private:
    GLuint mName = 0;
};

void deleteBuffer(GLuint name);
void deleteTexture(GLuint name);
void deleteFramebuffer(GLuint name);
void deleteVertexArray(GLuint name);
void deleteProgram(GLuint name);
void deleteShader(GLuint name);

using VertexArray = GlObject<deleteVertexArray>;
using Program = GlObject<deleteProgram>;
using Shader = GlObject<deleteShader>;
using Framebuffer = GlObject<deleteFramebuffer>;

VertexArray makeVertexArray();
Framebuffer makeFramebuffer();

// Storage of a size that grows by being made anew. With a format, shaders can read it as texels.
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(GLenum format) : mFormat(format) {}

    GLuint name() const { return mObject.name(); }
    size_t size() const { return mSize; }

    // Makes the buffer at least `bytes` large; true where its contents are lost.
    bool reserve(size_t bytes);
    void write(size_t offset, const void* bytes, size_t count);
    void bindTexels(Unit unit) const { glBindTextureUnit(GLuint(unit), mTexels.name()); }
    void bindStorage(Binding binding) const {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(binding), name());
    }
    template <class T>
    void read(std::span<T> out) const {
        glGetNamedBufferSubData(name(), 0, GLsizeiptr(out.size_bytes()), out.data());
    }

  private:
    GLenum mFormat = 0;
    GlObject<deleteBuffer> mObject;
    GlObject<deleteTexture> mTexels;
    size_t mSize = 0;
};

// A two-dimensional texture of one level that is made anew where it must be larger.
class Texture {
  public:
    explicit Texture(GLenum format) : mFormat(format) {}

    GLuint name() const { return mObject.name(); }
    int width() const { return mWidth; }
    int height() const { return mHeight; }
    // Makes it at least so large; true where it is a new one.
    bool reserve(int width, int height);

  private:
    GLenum mFormat;
    GlObject<deleteTexture> mObject;
    int mWidth = 0, mHeight = 0;
};

// A picture to draw into where there is no window: RGBA, as 32 bit floats (GL_RGBA32F) or bytes (GL_RGBA8),
// which is a quarter to read back.
class OffscreenTarget {
  public:
    OffscreenTarget(int width, int height, GLenum format = GL_RGBA32F);

    int width() const { return mWidth; }
    int height() const { return mHeight; }
    // What was drawn is lost. Cheap where it has been as large before.
    void resize(int width, int height);

    // Makes it the framebuffer that is drawn to, with a viewport that fills it.
    void bind() const;
    // The first `channels` of the four, rows from the top.
    Image read(int channels) const;
    // 0xAARRGGBB, rows from the top, width() x height() of them.
    void readArgb(std::span<uint32_t> pixels) const;

  private:
    Texture mTexture;
    Framebuffer mFramebuffer;
    int mWidth = 0, mHeight = 0;  // of the part of the texture that is drawn to
};

// What a frame changes in the context, put back when it ends: framebuffers, viewport, program, vertex array,
// capabilities, the first kUnitCount texture units, uniform buffer 0 and the first kBindingCount storage
// buffers. Of image units it takes the first and leaves it without an image.
class StateScope {
  public:
    StateScope();
    ~StateScope();
    StateScope(const StateScope&) = delete;
    StateScope& operator=(const StateScope&) = delete;

    GLint drawFramebuffer() const { return mDrawFramebuffer; }
    std::span<const GLint, 4> viewport() const { return mViewport; }

  private:
    GLint mDrawFramebuffer = 0, mReadFramebuffer = 0;
    GLint mViewport[4] = {};
    GLint mProgram = 0, mVertexArray = 0, mActiveTexture = 0;
    GLint mPatchVertices = 0, mIndirectBuffer = 0, mDispatchBuffer = 0, mUniformBuffer = 0;
    GLint mStorageBuffer = 0;
    struct UnitState {
        GLint picture = 0, texels = 0, sampler = 0;
    };
    std::vector<UnitState> mUnits;
    std::vector<GLint> mStorageBuffers;
    std::vector<GLboolean> mEnabled;
};

}  // namespace tessera::render
