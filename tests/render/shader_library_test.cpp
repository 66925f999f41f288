// Shaders are put together from files, and what is wrong with one is said with its file and line.
#include "render/shader_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/gl.h"

namespace tessera::render {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Sources = std::map<std::string_view, std::string_view>;

TEST(AssembleShader, IncludesEachFileOnceAndKnowsWhereLinesAreFrom) {
    const Sources sources{
        {"a.frag", "#version 450\n#include \"include/b.glsl\"\n#include \"include/c.glsl\"\nmain"},
        {"include/b.glsl", "b1\n#include \"include/c.glsl\"\nb3\n"},
        {"include/c.glsl", "c1\n"}};
    const std::vector<std::string> defines{"#define SAMPLES 4"};
    const auto shader = assembleShader(sources, "a.frag", defines);
    ASSERT_TRUE(shader);
    EXPECT_EQ(shader->text, "#version 450\n#define SAMPLES 4\nb1\nc1\nb3\nmain\n");
    std::vector<std::string> origins;
    for (const auto& [file, line] : shader->origins) origins.push_back(file + ":" + std::to_string(line));
    EXPECT_THAT(origins, ElementsAre("a.frag:1", "a.frag:1", "include/b.glsl:1", "include/c.glsl:1",
                                     "include/b.glsl:3", "a.frag:4"));
}

TEST(AssembleShader, NamesAMissingFile) {
    const Sources sources{{"a.frag", "#version 450\n#include \"include/b.glsl\"\n"}};
    const auto shader = assembleShader(sources, "a.frag");
    ASSERT_FALSE(shader);
    EXPECT_EQ(shader.error().code, ErrorCode::Internal);
    EXPECT_THAT(shader.error().message, HasSubstr("include/b.glsl"));
}

class ShaderLibrary : public testing::GlTest {};

TEST_F(ShaderLibrary, ErrorsNameFileAndLine) {
    const Sources sources{
        {"a.comp",
         "#version 450 core\n#include \"include/b.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n"},
        {"include/b.glsl", "float one = 1.0;\nfloat two = three;\n"}};
    const auto program = makeProgram(std::array<std::string_view, 1>{"a.comp"}, {}, sources);
    ASSERT_FALSE(program);
    EXPECT_THAT(program.error().message, HasSubstr("a.comp"));
    EXPECT_THAT(program.error().message, HasSubstr("include/b.glsl:2"));
}

TEST_F(ShaderLibrary, LinkErrorsAreReported) {
    const Sources sources{{"a.vert", "#version 450 core\nvoid f();\nvoid main() { f(); }\n"}};
    const auto program = makeProgram(std::array<std::string_view, 1>{"a.vert"}, {}, sources);
    ASSERT_FALSE(program);
    EXPECT_THAT(program.error().message, HasSubstr("a.vert"));
}

}  // namespace
}  // namespace tessera::render
