// The layers of the source tree, as rules on #include lines.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace tessera {

// What an #include line names, or none where the line is no such.
struct IncludeLine {
    std::string target;
    bool quoted = false;
};
inline std::optional<IncludeLine> parseInclude(std::string_view line) {
    const auto skipSpace = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
    const auto skip = [&](std::string_view word) {
        if (!line.starts_with(word)) return false;
        line.remove_prefix(word.size());
        skipSpace();
        return true;
    };
    skipSpace();
    if (!skip("#") || !skip("include") || line.empty()) return {};
    const bool quoted = line.front() == '"';
    if (!quoted && line.front() != '<') return {};
    const size_t end = line.find(quoted ? '"' : '>', 1);
    if (end == std::string_view::npos) return {};
    return IncludeLine{std::string(line.substr(1, end - 1)), quoted};
}

// What kind of library an include in angle brackets belongs to.
enum class Library { Other, Qt, QtWidgets, Gl, Numerics };

inline Library libraryOf(std::string_view target) {
    const auto startsWithAny = [&](std::initializer_list<std::string_view> prefixes) {
        return std::any_of(prefixes.begin(), prefixes.end(), [&](auto p) { return target.starts_with(p); });
    };
    if (startsWithAny({"GL/", "GLES", "EGL/", "KHR/", "GLFW/", "epoxy/", "glad/"})) return Library::Gl;
    if (startsWithAny(
            {"Eigen/", "unsupported/Eigen/", "opencv2/", "nlopt.", "OpenImageIO/", "tbb/", "oneapi/"}))
        return Library::Numerics;
    const bool qtClass = target.size() > 1 && target[0] == 'Q' && target[1] >= 'A' && target[1] <= 'Z';
    if (!qtClass && !startsWithAny({"Qt"})) return Library::Other;
    if (startsWithAny({"QtWidgets", "QtOpenGL", "QOpenGL"})) return Library::QtWidgets;
    // Of the classes of QtWidgets those that one would reach for; the rest the compiler does not find, since
    // the module's folder is not on the path of a target that does not link it.
    for (const std::string_view part :
         {"QApplication", "Widget", "Dialog", "Layout", "Button", "Label", "MenuBar", "MessageBox",
          "MainWindow", "ComboBox", "SpinBox", "CheckBox", "LineEdit", "ToolBar", "StatusBar", "ProgressBar",
          "QFrame", "QMenu", "QStyle"})
        if (target.find(part) != std::string_view::npos) return Library::QtWidgets;
    return Library::Qt;
}

// Why `file` (a path from the root of the tree, such as "core/mesh/tps.h") must not have this line; empty
// where it may.
inline std::string layerViolation(std::string_view file, std::string_view line) {
    const auto include = parseInclude(line);
    if (!include) return {};
    const std::string_view layer = file.substr(0, file.find('/'));
    const std::string_view name = file.substr(file.rfind('/') + 1);
    // The programs' own files may include what they put together.
    const bool editorMain = file == "app/main.cpp";
    const bool commandLine = layer == "app" && name.starts_with("cli_");
    const auto no = [&](std::string_view rule) {
        return std::string(file) + " includes " + include->target + ": " + std::string(rule);
    };

    if (include->quoted) {
        const std::string_view to = std::string_view(include->target).substr(0, include->target.find('/'));
        constexpr std::array<std::string_view, 4> kLayers{"core", "app", "render", "ui"};
        if (std::find(kLayers.begin(), kLayers.end(), to) == kLayers.end())
            return no("includes in quotes begin with a layer's folder");
        if (to == layer) {
            const bool toCommandLine = include->target.starts_with("app/cli_");
            return toCommandLine && !commandLine ? no("nothing but tessera-cli uses its parts") : "";
        }
        if (layer == "core") return no("core uses no other layer");
        if (layer == "render" && to != "core") return no("render uses core alone");
        if (layer == "app" && to == "ui" && !editorMain) return no("app does not know the window");
        if (layer == "app" && to == "render" && !commandLine) return no("app does not draw with OpenGL");
        if (layer == "ui" && include->target.starts_with("app/cli_"))
            return no("nothing but tessera-cli uses its parts");
        return {};
    }

    switch (libraryOf(include->target)) {
        case Library::Other:
            return {};
        case Library::Qt:
            if (layer == "core" || layer == "render") return no("core and render have no Qt");
            if (commandLine) return no("tessera-cli has no Qt");
            return {};
        case Library::QtWidgets:
            return layer == "ui" || editorMain ? "" : no("widgets are for ui alone");
        case Library::Gl:
            return layer == "render" ? "" : no("OpenGL is for render alone");
        case Library::Numerics:
            if (layer != "core") return no("core's libraries are for core alone");
            return name.ends_with(".h") ? no("headers of core show none of the libraries behind it") : "";
    }
    return {};
}

}  // namespace tessera
