// See shader_library.h.
#include "render/shader_library.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace tessera::render {

namespace {

constexpr std::string_view kInclude = "#include \"";

GLenum stageOf(std::string_view name) {
    const std::string_view suffix = name.substr(std::min(name.rfind('.') + 1, name.size()));
    if (suffix == "vert") return GL_VERTEX_SHADER;
    if (suffix == "tesc") return GL_TESS_CONTROL_SHADER;
    if (suffix == "tese") return GL_TESS_EVALUATION_SHADER;
    if (suffix == "frag") return GL_FRAGMENT_SHADER;
    return GL_COMPUTE_SHADER;
}

Result<void> append(const std::map<std::string_view, std::string_view>& shaders, std::string_view name,
                    std::span<const std::string> defines, ShaderText& result) {
    const auto found = shaders.find(name);
    if (found == shaders.end())
        return failure(ErrorCode::Internal, "the program has no shader '" + std::string(name) + "'");
    const size_t file = result.files.size();
    result.files.emplace_back(name);
    const auto mark = [&](int line) {
        result.text += "#line " + std::to_string(line) + " " + std::to_string(file) + "\n";
    };
    if (file > 0) mark(1);
    std::string_view rest = found->second;
    for (int line = 1; !rest.empty(); ++line) {
        const size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view text = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (text.starts_with(kInclude)) {
            const std::string_view target =
                text.substr(kInclude.size(), text.find('"', kInclude.size()) - kInclude.size());
            if (std::find(result.files.begin(), result.files.end(), target) == result.files.end())
                if (auto included = append(shaders, target, {}, result); !included) return included;
            mark(line + 1);
            continue;
        }
        result.text.append(text).append("\n");
        if (line > 1 || defines.empty()) continue;
        for (const std::string& define : defines) result.text += define + "\n";
        mark(2);
    }
    return {};
}

// The driver's first line, its "FILE:LINE" or "FILE(LINE)" in front read as a name.
std::string readable(std::string_view log, const std::vector<std::string>& files) {
    std::string_view line = log.substr(0, log.find('\n'));
    size_t file = 0;
    const char* const end = line.data() + line.size();
    const auto [after, error] = std::from_chars(line.data(), end, file);
    if (error != std::errc() || file >= files.size() || after == end || (*after != ':' && *after != '('))
        return std::string(line);
    line.remove_prefix(size_t(after - line.data()) + 1);
    return files[file] + ":" + std::string(line);
}

Result<Shader> compile(const ShaderText& source, std::string_view name) {
    Shader shader(glCreateShader(stageOf(name)));
    const char* text = source.text.c_str();
    glShaderSource(shader.name(), 1, &text, nullptr);
    glCompileShader(shader.name());
    GLint good = 0, length = 0;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &good);
    if (good) return shader;
    glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
    std::string log(size_t(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader.name(), length, nullptr, log.data());
    return failure(ErrorCode::Internal,
                   "the driver refuses shader " + std::string(name) + ": " + readable(log, source.files));
}

}  // namespace

Result<ShaderText> assembleShader(const std::map<std::string_view, std::string_view>& shaders,
                                  std::string_view name, std::span<const std::string> defines) {
    ShaderText result;
    if (auto done = append(shaders, name, defines, result); !done) return tl::unexpected(done.error());
    return result;
}

Result<Program> makeProgram(std::span<const std::string_view> names, std::span<const std::string> defines,
                            const std::map<std::string_view, std::string_view>& shaders) {
    Program program(glCreateProgram());
    for (const std::string_view name : names) {
        const auto source = assembleShader(shaders, name, defines);
        if (!source) return tl::unexpected(source.error());
        const auto shader = compile(*source, name);
        if (!shader) return tl::unexpected(shader.error());
        glAttachShader(program.name(), shader->name());
    }
    glLinkProgram(program.name());
    GLint good = 0, length = 0;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &good);
    if (good) return program;
    glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
    std::string log(size_t(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program.name(), length, nullptr, log.data());
    return failure(ErrorCode::Internal, "the driver cannot link " + std::string(names.front()) + ": " +
                                            log.substr(0, log.find('\n')));
}

}  // namespace tessera::render
