// Where there is no OpenGL 4.5, that is an error value with a sentence; and a frame leaves the context as it
// was.
#include "render/offscreen_gl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "tests/support/gl.h"
#include "tests/support/test_meshes.h"

namespace tessera::render {
namespace {

using ::testing::HasSubstr;

// The message of OffscreenGl::create() in a process of its own (EGL reads its environment once) with a
// variable set; "ok" where there is a context.
std::string messageWith(const char* variable, const char* value) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        setenv(variable, value, 1);
        const auto context = OffscreenGl::create();
        const std::string message = context ? "ok" : context.error().message;
        const bool right = context || context.error().code == ErrorCode::Internal;
        const bool written = write(ends[1], message.data(), message.size()) == ssize_t(message.size());
        _exit(right && written ? 0 : 1);
    }
    close(ends[1]);
    std::string message;
    char buffer[256];
    for (ssize_t n; (n = read(ends[0], buffer, sizeof(buffer))) > 0;) message.append(buffer, size_t(n));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    return message;
}

TEST(OffscreenGlFallback, NoDriverIsAnError) {
    EXPECT_THAT(messageWith("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json"),
                HasSubstr("OpenGL 4.5 is not available"));
}

TEST(OffscreenGlFallback, AnOlderVersionIsAnError) {
    if (messageWith("LC_ALL", "C") != "ok") GTEST_SKIP() << "no OpenGL 4.5";
    const std::string message = messageWith("MESA_GL_VERSION_OVERRIDE", "4.3");
    if (message == "ok") GTEST_SKIP() << "not Mesa's driver";
    EXPECT_THAT(message, HasSubstr("OpenGL 4.5 is not available"));
    EXPECT_THAT(message, HasSubstr("draw with the CPU"));
}

class Context : public testing::GlTest {};

TEST_F(Context, SaysWhatDraws) {
    const GlDevice device = currentDevice();
    EXPECT_FALSE(device.name.empty());
    EXPECT_EQ(device.software, device.name.find("llvmpipe") != std::string::npos);
}

GLint integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

TEST_F(Context, IsLeftAsItWas) {
    const PatchMesh mesh = testing::curvedMesh(60, 40, 4, 3, 1);
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer);
    renderer->setMesh(mesh);
    const OffscreenTarget target(60, 40);
    target.bind();
    const VertexArray vertexArray = makeVertexArray();
    glBindVertexArray(vertexArray.name());
    Texture texture(GL_RGBA8);
    texture.reserve(4, 4);
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glActiveTexture(GL_TEXTURE1);
    Buffer buffer;
    buffer.reserve(64);
    buffer.bindStorage(Binding::Draws);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer.name());
    glEnable(GL_BLEND);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 1, 1);
    glViewport(0, 0, 60, 40);
    const GLint framebuffer = integer(GL_DRAW_FRAMEBUFFER_BINDING);

    for (const bool subdivision : {false, true}) {
        ASSERT_TRUE(renderer->draw(wholePicture(mesh, {1, 1}), {.computeSubdivision = subdivision}));
        EXPECT_EQ(integer(GL_DRAW_FRAMEBUFFER_BINDING), framebuffer);
        EXPECT_EQ(integer(GL_VERTEX_ARRAY_BINDING), GLint(vertexArray.name()));
        EXPECT_EQ(integer(GL_CURRENT_PROGRAM), 0);
        EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), GL_TEXTURE1);
        glActiveTexture(GL_TEXTURE2);
        EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), GLint(texture.name()));
        EXPECT_EQ(integer(GL_TEXTURE_BINDING_BUFFER), 0);
        glActiveTexture(GL_TEXTURE1);
        GLint bound = 0;
        glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, GLuint(Binding::Draws), &bound);
        EXPECT_EQ(bound, GLint(buffer.name()));
        glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 0, &bound);
        EXPECT_EQ(bound, GLint(buffer.name()));
        EXPECT_TRUE(glIsEnabled(GL_BLEND));
        EXPECT_TRUE(glIsEnabled(GL_SCISSOR_TEST));
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    }
    // The scissor was off meanwhile.
    EXPECT_GT(target.read(4).at(30, 20, 3), 0);
}

TEST_F(Context, ErrorsSinceTheLastCallAreToldOnce) {
    EXPECT_TRUE(checkDrawn());
    glEnable(GL_TRIANGLES);
    const auto failed = checkDrawn();
    ASSERT_FALSE(failed);
    EXPECT_NE(failed.error().message.find(std::to_string(GL_INVALID_ENUM)), std::string::npos);
    EXPECT_TRUE(checkDrawn());
}

// The canvas and the overview take turns: neither is drawn into storage that has to be made first.
TEST_F(Context, AFrameIsTheSameInATargetThatWasLarger) {
    const PatchMesh mesh = testing::curvedMesh(60, 40, 4, 3, 1);
    for (const bool subdivision : {false, true}) {
        auto renderer = Renderer::create();
        ASSERT_TRUE(renderer);
        renderer->setMesh(mesh);
        OffscreenTarget target(120, 50);
        const auto frame = [&](double scale) {
            const View view = wholePicture(mesh, {scale, scale});
            target.resize(view.width, view.height);
            target.bind();
            EXPECT_TRUE(renderer->draw(view, {.computeSubdivision = subdivision}));
            return target.read(4);
        };
        const Image small = frame(1), large = frame(2), again = frame(1);
        EXPECT_EQ(large.width(), 120);
        EXPECT_EQ(large.height(), 80);
        ASSERT_EQ(again.width(), 60);
        ASSERT_EQ(again.height(), 40);
        for (int c = 0; c < 4; ++c) EXPECT_TRUE(std::ranges::equal(again.plane(c), small.plane(c)));
    }
}

TEST_F(Context, BytesAreTheRoundedFloats) {
    const PatchMesh mesh = testing::curvedMesh(60, 40, 4, 3, 1);
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer);
    renderer->setMesh(mesh);
    const View view = wholePicture(mesh, {1, 1});
    const OffscreenTarget floats(60, 40), bytes(60, 40, GL_RGBA8);
    for (const OffscreenTarget* target : {&floats, &bytes}) {
        target->bind();
        ASSERT_TRUE(renderer->draw(view));
    }
    const Image expected = floats.read(4);
    std::vector<uint32_t> argb(size_t(60 * 40));
    bytes.readArgb(argb);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 60; ++x)
            for (int c = 0; c < 4; ++c) {
                const uint32_t pixel = argb[size_t(y * 60 + x)];
                const int value = int(pixel >> (c == 3 ? 24 : 16 - 8 * c) & 0xffU);
                ASSERT_NEAR(value, 255 * std::clamp(expected.at(x, y, c), 0.F, 1.F), .51) << x << ' ' << y;
            }
}

TEST_F(Context, AFrameFillsTheViewportAndNothingElse) {
    const PatchMesh mesh = testing::curvedMesh(30, 20, 4, 3, 1);
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer);
    renderer->setMesh(mesh);
    const OffscreenTarget whole(60, 40);
    whole.bind();
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glViewport(10, 5, 30, 20);  // from below
    const View view = wholePicture(mesh, {1, 1});
    ASSERT_TRUE(renderer->draw(view, {.samples = 1}));
    const Image frame = whole.read(4), part = testing::drawOffscreen(mesh, view, {.samples = 1});
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 60; ++x) {
            const bool inside = x >= 10 && x < 40 && y >= 15 && y < 35;
            EXPECT_EQ(frame.at(x, y, 3), inside ? 1 : 0);
            EXPECT_EQ(frame.at(x, y, 0), inside ? part.at(x - 10, y - 15, 0) : 0);
        }
}

}  // namespace
}  // namespace tessera::render
