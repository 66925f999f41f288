// How long tools take on a document of 20,000 patches, or on the one named: what a person feels between a
// movement of the hand and the next frame, drawing apart.
//
//     tools_bench [FILE.tessera]
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "app/recolour_gesture.h"
#include "app/selection_actions.h"
#include "app/tools/blur_tool.h"
#include "app/tools/tool_manager.h"
#include "core/document/codec.h"
#include "tests/support/test_meshes.h"

namespace {

using namespace tessera;

PatchMesh manyPatches() {
    PatchMesh mesh = testing::gridMesh(2400, 1600, 120, 84);
    std::mt19937 random(1);
    mesh.forEachPatch([&](PatchId p) { mesh.setSpline(p, testing::randomSpline(3, random)); });
    return mesh;
}

double millisecondsOf(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void print(const char* what, const std::function<void()>& work) {
    std::printf("%-44s %8.2f ms\n", what, millisecondsOf(work));
}

// The mean and the longest of many frames.
void printFrames(const char* what, int count, const std::function<void(int)>& frame) {
    double sum = 0, most = 0;
    for (int i = 0; i < count; ++i) {
        const double time = millisecondsOf([&] { frame(i); });
        sum += time;
        most = std::max(most, time);
    }
    std::printf("%-44s %8.2f ms, at most %.2f\n", what, sum / count, most);
}

// The curve in the middle of the feature of the most curves; none where there are no features.
EdgeId inLongestFeature(const PatchMesh& mesh) {
    std::vector<EdgeId> longest;
    std::vector<bool> seen(mesh.connectivity().edgeCapacity(), false);
    mesh.forEachEdge([&](EdgeId e) {
        if (!mesh.curve(e).feature || seen[e.index]) return;
        std::vector<EdgeId> feature = wholeFeature(mesh, e);
        for (const EdgeId part : feature) seen[part.index] = true;
        if (feature.size() > longest.size()) longest = std::move(feature);
    });
    return longest.empty() ? EdgeId() : longest[longest.size() / 2];
}

void soften(ToolManager& tools, const PatchMesh& mesh) {
    const EdgeId feature = inLongestFeature(mesh);
    if (!feature.valid()) return;
    const glm::dvec2 from = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(feature))).at(.5);
    std::printf("%-44s %8zu curves\n", "the longest feature", wholeFeature(mesh, feature).size());
    tools.setTool(ToolId::Blur);
    tools.press({from});
    print("softening it, first frame", [&] { tools.move({from + 5.}); });
    printFrames("softening it, a frame", 20, [&](int i) { tools.move({from + (5. + i)}); });
    tools.release({from + 25.});
}

void run(DocumentSession& session) {
    ToolManager tools;
    tools.setSession(&session);
    const PatchMesh& mesh = session.document().mesh;
    const double width = mesh.width(), height = mesh.height();
    VertexId middle;
    double nearest = 1e30;
    mesh.forEachVertex([&](VertexId v) {
        const double distance = glm::distance(toPixels(mesh.position(v)), {.5 * width, .5 * height});
        if (distance < nearest) {
            nearest = distance;
            middle = v;
        }
    });
    const glm::dvec2 at = toPixels(mesh.position(middle));

    print("first look-up (index of places)", [&] { (void)session.query().patchAt(at); });
    print("mean colours", [&] { (void)session.colours(); });
    print("click", [&] {
        tools.press({at});
        tools.release({at});
    });
    tools.press({{0, 0}});
    printFrames("marquee, a frame", 50,
                [&](int i) { tools.move({{width * (i + 1) / 50, height * (i + 1) / 50}}); });
    tools.release({{width, height}});
    print("region enclosed by features", [&] { tools.doubleClick({at}); });
    tools.release({at});
    tools.setTool(ToolId::Wand);
    print("wand", [&] {
        tools.press({at});
        tools.release({at});
    });
    print("all", [&] { selectAll(session); });
    {
        RecolourGesture gesture(session, "Hue");
        printFrames("hue of all patches, a frame", 5,
                    [&](int i) { gesture.show(ColourShift{10. * i + 5, 1, 0}); });
        printFrames("tint of all patches, a frame", 5,
                    [&](int i) { gesture.show(Tint{{1, 0, 0}, .1 * i + .1}); });
        print("its end", [&] { gesture.commit(finishNow); });
    }
    std::printf("%-44s %8.2f MB\n", "held by that step", double(session.history().bytes()) / (1 << 20));
    print("undo", [&] { session.history().undo(); });

    tools.setTool(ToolId::Direct);
    printFrames("hover, a frame", 100, [&](int i) { tools.move({at + .1 * i}); });
    tools.press({at});
    printFrames("drag of a vertex, a frame", 100,
                [&](int i) { tools.move({at + glm::dvec2(.05 * i + 4.1, 1)}); });
    print("its end", [&] { tools.release({at + glm::dvec2(9, 1)}); });
    std::printf("%-44s %8.2f MB\n", "held by that step", double(session.history().bytes()) / (1 << 20));
    print("hover after it (index built again)", [&] { tools.move({.3 * at}); });
    tools.setTool(ToolId::Brush);
    tools.press({at});
    printFrames("brush, a frame", 40, [&](int i) { tools.move({at + glm::dvec2(3. * i, i)}); });
    tools.release({at});
    soften(tools, session.document().mesh);
    tools.setSession(nullptr);
}

}  // namespace

int main(int argc, char** argv) {
    Document document;
    if (argc > 1) {
        Result<Document> loaded = loadDocument(argv[1]);
        if (!loaded) {
            std::fprintf(stderr, "%s\n", loaded.error().message.c_str());
            return 1;
        }
        document = std::move(*loaded);
    } else {
        document.mesh = manyPatches();
    }
    std::printf("%zu patches, %d x %d\n", document.mesh.patchCount(), document.mesh.width(),
                document.mesh.height());
    DocumentSession session(std::move(document), {}, {});
    run(session);
    return 0;
}
