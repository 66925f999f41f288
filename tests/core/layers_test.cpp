// The layers hold: no file includes what its layer must not know. The rules are in support/layers.h.
#include "tests/support/layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

namespace tessera {
namespace {

namespace fs = std::filesystem;

bool isSource(const fs::path& path) {
    return path.extension() == ".h" || path.extension() == ".cpp";
}

TEST(Layers, HoldInEverySourceFile) {
    const fs::path root = TESSERA_SOURCE_DIR;
    std::map<std::string, int> includesByLayer;
    for (const char* layer : {"core", "app", "render", "ui"}) {
        if (!fs::is_directory(root / layer)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / layer)) {
            if (!isSource(entry.path())) continue;
            const std::string file = entry.path().lexically_relative(root).generic_string();
            std::ifstream stream(entry.path());
            ASSERT_TRUE(stream) << file;
            std::string line;
            for (int number = 1; std::getline(stream, line); ++number) {
                includesByLayer[layer] += parseInclude(line).has_value();
                EXPECT_EQ(layerViolation(file, line), "") << file << ":" << number;
            }
        }
    }
    // That the walk has seen the tree, and the parser its lines.
    EXPECT_GT(includesByLayer["core"], 100);
    EXPECT_GT(includesByLayer["app"], 50);
    EXPECT_GT(includesByLayer["ui"], 50);
}

struct Line {
    const char* file;
    const char* line;
};

TEST(Layers, WrongIncludesAreFound) {
    const Line wrong[] = {
        {"core/mesh/tps.h", "#include <QString>"},
        {"core/mesh/tps.cpp", "#include <QtCore/QString>"},
        {"core/mesh/tps.cpp", "  #  include <GL/gl.h>"},
        {"core/mesh/tps.cpp", "#include <EGL/egl.h>"},
        {"core/mesh/tps.cpp", "#include \"app/settings.h\""},
        {"core/mesh/tps.cpp", "#include \"tps.h\""},
        {"core/mesh/tps.h", "#include <Eigen/Dense>"},
        {"core/mesh/tps.h", "#include <opencv2/core.hpp>"},
        {"core/mesh/tps.h", "#include <nlopt.hpp>"},
        {"core/mesh/tps.h", "#include <OpenImageIO/imageio.h>"},
        {"core/mesh/tps.h", "#include <tbb/parallel_for.h> // fast"},
        {"render/renderer.cpp", "#include <QOpenGLContext>"},
        {"render/renderer.cpp", "#include <QImage>"},
        {"render/renderer.cpp", "#include \"app/workspace.h\""},
        {"render/renderer.cpp", "#include \"ui/theme.h\""},
        {"app/workspace.cpp", "#include <QMessageBox>"},
        {"app/workspace.cpp", "#include <QtWidgets/QTreeView>"},
        {"app/workspace.cpp", "#include <QOpenGLWidget>"},
        {"app/workspace.cpp", "#include <GL/gl.h>"},
        {"app/workspace.cpp", "#include \"ui/main_window.h\""},
        {"app/workspace.cpp", "#include \"render/renderer.h\""},
        {"app/workspace.cpp", "#include \"app/cli_support.h\""},
        {"app/workspace.cpp", "#include <Eigen/Dense>"},
        {"app/cli_info.cpp", "#include <QString>"},
        {"ui/theme.cpp", "#include <GL/gl.h>"},
        {"ui/theme.cpp", "#include <opencv2/core.hpp>"},
        {"ui/theme.cpp", "#include \"app/cli_support.h\""},
        {"ui/theme.cpp", "#include \"theme.h\""},
    };
    for (const Line& w : wrong) {
        const std::string message = layerViolation(w.file, w.line);
        EXPECT_THAT(message, testing::StartsWith(std::string(w.file) + " includes ")) << w.line;
    }
}

TEST(Layers, RightIncludesPass) {
    const Line right[] = {
        {"core/mesh/tps.cpp", "#include <Eigen/Dense>"},
        {"core/mesh/tps.h", "#include <glm/vec2.hpp>"},
        {"core/mesh/tps.h", "#include \"core/mesh/bezier.h\""},
        {"core/mesh/tps.h", "// as with #include <QString>"},
        {"core/mesh/tps.h", "#include"},
        {"core/mesh/tps.h", "#define QT <QString>"},
        {"render/renderer.cpp", "#include <GL/gl.h>"},
        {"render/renderer.cpp", "#include \"core/mesh/patch_mesh.h\""},
        {"app/workspace.h", "#include <QObject>"},
        {"app/workspace.h", "#include <QUndoStack>"},
        {"app/main.cpp", "#include <QApplication>"},
        {"app/main.cpp", "#include \"ui/main_window.h\""},
        {"app/cli_render.cpp", "#include \"render/renderer.h\""},
        {"app/cli_render.cpp", "#include \"app/cli_support.h\""},
        {"ui/theme.cpp", "#include <QApplication>"},
        {"ui/theme.cpp", "#include \"app/settings.h\""},
    };
    for (const Line& r : right) EXPECT_EQ(layerViolation(r.file, r.line), "") << r.line;
}

}  // namespace
}  // namespace tessera
