// The shaders, which are compiled into the program, and programs made of them.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "render/gl_objects.h"

namespace tessera::render {

// All shaders by their names relative to the folder shaders/.
const std::map<std::string_view, std::string_view>& embeddedShaders();

// The text of a shader with `#include "include/NAME.glsl"` replaced by the file, each file once, and
// `defines` (whole lines, such as "#define SAMPLES 4") after the first line. Internal where a file is
// missing.
struct ShaderText {
    struct Origin {
        std::string file;
        int line = 0;
    };
    std::string text;
    std::vector<Origin> origins;  // by line of the text
};
Result<ShaderText> assembleShader(const std::map<std::string_view, std::string_view>& shaders,
                                  std::string_view name, std::span<const std::string> defines = {});

// Links the shaders named, whose suffixes say their stages, to a program of the current context. Internal,
// with the driver's first message and the file and line that it is about, where that fails.
Result<Program> makeProgram(std::span<const std::string_view> names,
                            std::span<const std::string> defines = {},
                            const std::map<std::string_view, std::string_view>& shaders = embeddedShaders());

}  // namespace tessera::render
