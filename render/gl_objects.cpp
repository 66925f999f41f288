// See gl_objects.h.
#include "render/gl_objects.h"

#include <algorithm>
#include <array>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace tessera::render {

namespace {

// What would change a frame of ours if it were on.
constexpr std::array<GLenum, 8> kCapabilities{GL_BLEND,          GL_CULL_FACE,       GL_DEPTH_TEST,
                                              GL_SCISSOR_TEST,   GL_STENCIL_TEST,    GL_RASTERIZER_DISCARD,
                                              GL_COLOR_LOGIC_OP, GL_FRAMEBUFFER_SRGB};

GLint integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

GLint integer(GLenum name, GLuint index) {
    GLint value = 0;
    glGetIntegeri_v(name, index, &value);
    return value;
}

}  // namespace

void deleteBuffer(GLuint name) {
    glDeleteBuffers(1, &name);
}
void deleteTexture(GLuint name) {
    glDeleteTextures(1, &name);
}
void deleteFramebuffer(GLuint name) {
    glDeleteFramebuffers(1, &name);
}
void deleteVertexArray(GLuint name) {
    glDeleteVertexArrays(1, &name);
}
void deleteProgram(GLuint name) {
    glDeleteProgram(name);
}
void deleteShader(GLuint name) {
    glDeleteShader(name);
}

VertexArray makeVertexArray() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return VertexArray(name);
}

Framebuffer makeFramebuffer() {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    return Framebuffer(name);
}

bool Buffer::reserve(size_t bytes) {
    if (bytes <= mSize && name() != 0) return false;
    // Half as much again, so that a mesh that grows patch by patch does not ask every time.
    mSize = name() != 0 ? std::max(bytes, mSize + mSize / 2) : std::max<size_t>(bytes, 16);
    GLuint fresh = 0;
    glCreateBuffers(1, &fresh);
    mObject = GlObject<deleteBuffer>(fresh);
    glNamedBufferStorage(fresh, GLsizeiptr(mSize), nullptr, GL_DYNAMIC_STORAGE_BIT);
    if (mFormat != 0) {
        GLuint texels = 0;
        glCreateTextures(GL_TEXTURE_BUFFER, 1, &texels);
        glTextureBuffer(texels, mFormat, fresh);
        mTexels = GlObject<deleteTexture>(texels);
    }
    return true;
}

void Buffer::write(size_t offset, const void* bytes, size_t count) {
    glNamedBufferSubData(name(), GLintptr(offset), GLsizeiptr(count), bytes);
}

bool Texture::reserve(int width, int height) {
    if (width <= mWidth && height <= mHeight) return false;
    width = std::max(width, mWidth);
    height = std::max(height, mHeight);
    GLuint fresh = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &fresh);
    mObject = GlObject<deleteTexture>(fresh);
    glTextureStorage2D(fresh, 1, mFormat, width, height);
    glTextureParameteri(fresh, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(fresh, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    mWidth = width;
    mHeight = height;
    return true;
}

OffscreenTarget::OffscreenTarget(int width, int height, GLenum format)
    : mTexture(format), mFramebuffer(makeFramebuffer()) {
    resize(width, height);
}

void OffscreenTarget::resize(int width, int height) {
    mWidth = width;
    mHeight = height;
    if (mTexture.reserve(width, height))
        glNamedFramebufferTexture(mFramebuffer.name(), GL_COLOR_ATTACHMENT0, mTexture.name(), 0);
}

void OffscreenTarget::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, mFramebuffer.name());
    glViewport(0, 0, mWidth, mHeight);
}

Image OffscreenTarget::read(int channels) const {
    constexpr size_t kChannels = 4;
    const int width = mWidth, height = mHeight;
    std::vector<float> pixels(size_t(width) * size_t(height) * kChannels);
    glGetTextureSubImage(mTexture.name(), 0, 0, 0, 0, width, height, 1, GL_RGBA, GL_FLOAT,
                         GLsizei(pixels.size() * sizeof(float)), pixels.data());
    Image image(width, height, channels);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < height; ++y) {
            const float* from = &pixels[size_t(height - 1 - y) * size_t(width) * kChannels + size_t(c)];
            for (int x = 0; x < width; ++x) image.at(x, y, c) = from[size_t(x) * kChannels];
        }
    return image;
}

void OffscreenTarget::readArgb(std::span<uint32_t> pixels) const {
    const auto width = size_t(mWidth), height = size_t(mHeight);
    TESSERA_CHECK(pixels.size() == width * height);
    glGetTextureSubImage(mTexture.name(), 0, 0, 0, 0, mWidth, mHeight, 1, GL_BGRA,
                         GL_UNSIGNED_INT_8_8_8_8_REV, GLsizei(pixels.size_bytes()), pixels.data());
    // OpenGL's rows are from the bottom.
    parallelFor(height / 2, 64, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) {
            const auto upper = pixels.subspan(y * width, width);
            std::ranges::swap_ranges(upper, pixels.subspan((height - 1 - y) * width, width));
        }
    });
}

StateScope::StateScope()
    : mDrawFramebuffer(integer(GL_DRAW_FRAMEBUFFER_BINDING)),
      mReadFramebuffer(integer(GL_READ_FRAMEBUFFER_BINDING)),
      mProgram(integer(GL_CURRENT_PROGRAM)),
      mVertexArray(integer(GL_VERTEX_ARRAY_BINDING)),
      mActiveTexture(integer(GL_ACTIVE_TEXTURE)),
      mPatchVertices(integer(GL_PATCH_VERTICES)),
      mIndirectBuffer(integer(GL_DRAW_INDIRECT_BUFFER_BINDING)),
      mDispatchBuffer(integer(GL_DISPATCH_INDIRECT_BUFFER_BINDING)),
      mUniformBuffer(integer(GL_UNIFORM_BUFFER_BINDING, 0)),
      mStorageBuffer(integer(GL_SHADER_STORAGE_BUFFER_BINDING)) {
    glGetIntegerv(GL_VIEWPORT, mViewport);
    for (GLuint unit = 0; unit < kUnitCount; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        mUnits.push_back({integer(GL_TEXTURE_BINDING_2D), integer(GL_TEXTURE_BINDING_BUFFER),
                          integer(GL_SAMPLER_BINDING)});
        glBindSampler(unit, 0);
    }
    for (GLuint i = 0; i < kBindingCount; ++i)
        mStorageBuffers.push_back(integer(GL_SHADER_STORAGE_BUFFER_BINDING, i));
    for (const GLenum capability : kCapabilities) {
        mEnabled.push_back(glIsEnabled(capability));
        glDisable(capability);
    }
}

StateScope::~StateScope() {
    for (size_t i = 0; i < kCapabilities.size(); ++i)
        if (mEnabled[i]) glEnable(kCapabilities[i]);
    for (GLuint i = 0; i < kBindingCount; ++i)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, GLuint(mStorageBuffers[i]));
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, GLuint(mStorageBuffer));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, GLuint(mUniformBuffer));
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, GLuint(mIndirectBuffer));
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, GLuint(mDispatchBuffer));
    for (GLuint unit = 0; unit < kUnitCount; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, GLuint(mUnits[unit].picture));
        glBindTexture(GL_TEXTURE_BUFFER, GLuint(mUnits[unit].texels));
        glBindSampler(unit, GLuint(mUnits[unit].sampler));
    }
    glActiveTexture(GLenum(mActiveTexture));
    glPatchParameteri(GL_PATCH_VERTICES, mPatchVertices);
    glBindVertexArray(GLuint(mVertexArray));
    glUseProgram(GLuint(mProgram));
    glViewport(mViewport[0], mViewport[1], mViewport[2], mViewport[3]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(mDrawFramebuffer));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, GLuint(mReadFramebuffer));
}

}  // namespace tessera::render
