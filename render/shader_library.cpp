// See shader_library.h.
#include "render/shader_library.h"

#include <algorithm>
#include <charconv>
#include <set>
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
                    std::span<const std::string> defines, std::set<std::string_view>& included,
                    ShaderText& result) {
    const auto found = shaders.find(name);
    if (found == shaders.end())
        return failure(ErrorCode::Internal, "the program has no shader '" + std::string(name) + "'");
    included.insert(found->first);
    std::string_view rest = found->second;
    for (int line = 1; !rest.empty(); ++line) {
        const size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view text = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const auto add = [&](std::string_view added) {
            result.text.append(added).append("\n");
            result.origins.push_back({std::string(name), line});
        };
        if (text.starts_with(kInclude)) {
            const std::string_view target =
                text.substr(kInclude.size(), text.find('"', kInclude.size()) - kInclude.size());
            if (included.contains(target)) continue;
            if (auto done = append(shaders, target, {}, included, result); !done) return done;
            continue;
        }
        add(text);
        if (line == 1)
            for (const std::string& define : defines) add(define);
    }
    return {};
}

// The driver's first line with the place that it begins with, "0:LINE(COLUMN): " or "0(LINE) : ", as file and
// line. (Drivers differ in what they make of #line.)
std::string readable(std::string_view log, const ShaderText& source) {
    const std::string_view text = log.substr(0, log.find('\n'));
    const size_t separator = text.find_first_of(":(");
    if (separator == std::string_view::npos) return std::string(text);
    size_t line = 0;
    const char* const end = text.data() + text.size();
    const auto [after, error] = std::from_chars(text.data() + separator + 1, end, line);
    if (error != std::errc() || line == 0 || line > source.origins.size()) return std::string(text);
    const ShaderText::Origin& origin = source.origins[line - 1];
    const size_t message = text.find(": ", size_t(after - text.data()));
    return origin.file + ":" + std::to_string(origin.line) +
           std::string(message == std::string_view::npos ? "" : text.substr(message));
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
                   "the driver refuses shader " + std::string(name) + ": " + readable(log, source));
}

}  // namespace

Result<ShaderText> assembleShader(const std::map<std::string_view, std::string_view>& shaders,
                                  std::string_view name, std::span<const std::string> defines) {
    ShaderText result;
    std::set<std::string_view> included;
    if (auto done = append(shaders, name, defines, included, result); !done)
        return tl::unexpected(done.error());
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
