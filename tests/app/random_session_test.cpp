// Thousands of random events and commands: the mesh stays sound, and undoing all of them gives back the bytes
// of the start.
#include <gtest/gtest.h>

#include <QCoreApplication>
#include <array>
#include <random>

#include "app/edit_actions.h"
#include "app/element_edits.h"
#include "app/selection_actions.h"
#include "app/tools/tool_manager.h"
#include "core/edit/edge_edits.h"
#include "core/mesh/mesh_validate.h"
#include "tests/support/edits.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

constexpr int kWidth = 160, kHeight = 120;

std::shared_ptr<const Image> photo() {
    auto image = std::make_shared<Image>(kWidth, kHeight, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                image->at(x, y, c) = .5f + .4f * std::sin(.05f * float(x * (c + 1)) + .07f * float(y));
    return image;
}

// Colours that show the photo, so that reshapes refit them.
PatchMesh startMesh(unsigned seed) {
    PatchMesh mesh = testing::curvedMesh(kWidth, kHeight, 7, 5, seed);
    const auto image = photo();
    mesh.forEachPatch([&](PatchId p) {
        if (p.index % 2 == 0) return;
        const glm::dvec2 at = evaluate(toPixels(mesh.controlPoints(p)), {1. / 3, 1. / 3, 1. / 3});
        std::array<float, 3> colour;
        for (int c = 0; c < 3; ++c) colour[size_t(c)] = bilinear(*image, c, at.x, at.y);
        mesh.setSpline(p, constantSpline(colour));
    });
    return mesh;
}

class RandomSession {
  public:
    explicit RandomSession(unsigned seed) : mRandom(seed) {
        Document document;
        document.mesh = startMesh(seed);
        mSession = std::make_unique<DocumentSession>(document, Photo{photo(), nullptr, nullptr}, QString());
        mTools.setSession(mSession.get());
    }
    ~RandomSession() { mTools.setSession(nullptr); }

    void step() {
        switch (below(10)) {
            case 0:
                return mTools.setTool(ToolId(below(int(ToolId::Count))));
            case 1:
                return chooseOptions();
            case 2:
                return keys();
            case 3:
                return command();
            default:
                return pointer();
        }
    }
    DocumentSession& session() { return *mSession; }
    void endGesture() { mTools.cancel(); }

  private:
    int below(int count) { return int(mRandom() % unsigned(count)); }
    double unit() { return std::uniform_real_distribution<double>(0, 1)(mRandom); }
    glm::dvec3 colour() { return {unit(), unit(), unit()}; }
    ToolModifiers modifiers() { return {below(4) == 0, below(4) == 0, below(8) == 0}; }

    // Near where it was, mostly; on a control point rather often.
    ToolEvent event() {
        const PatchMesh& mesh = mSession->document().mesh;
        if (below(3) == 0) {
            mPoint = {-10 + (kWidth + 20) * unit(), -10 + (kHeight + 20) * unit()};
        } else if (below(2) == 0) {
            const VertexId v(uint32_t(below(int(mesh.connectivity().vertexCapacity()))));
            if (mesh.connectivity().alive(v)) mPoint = toPixels(mesh.position(v));
        } else {
            mPoint += glm::dvec2(20 * unit() - 10, 20 * unit() - 10);
        }
        return {mPoint, std::array{.02, .5, 1., 2.}[size_t(below(4))], modifiers()};
    }
    void pointer() {
        switch (below(8)) {
            case 0:
                return mTools.press(event());
            case 1:
                return mTools.release(event());
            case 2:
                return mTools.doubleClick(event());
            case 3:
                mTools.press(event());
                for (int i = below(4); i >= 0; --i) mTools.move(event());
                return mTools.release(event());
            case 4:
                return mTools.leave();
            default:
                return mTools.move(event());
        }
    }
    void keys() {
        const ToolKey key{ToolKeyCode(below(7)), modifiers(), .5 + unit()};
        mTools.keyPress(key);
        if (below(3) > 0) mTools.keyRelease(key);
    }
    void chooseOptions() {
        ToolOptions options;
        options.colour = colour();
        options.secondColour = colour();
        options.wand = {.2 * unit(), below(2) == 0, below(2) == 0};
        options.brushRadiusPx = 1 + 20 * unit();
        options.brushKeepsShading = below(2) == 0;
        options.featherPx = below(3) == 0 ? 10 * unit() : 0;
        options.allHandles = below(2) == 0;
        options.refitAfterReshape = below(4) == 0;
        options.wholeFeatures = below(2) == 0;
        mTools.setOptions(options);
    }
    // What menus and panels do; some of it is refused, which is right.
    void command() {
        DocumentSession& s = *mSession;
        switch (below(18)) {
            case 0:
                return selectAll(s);
            case 1:
                return invertSelection(s);
            case 2:
                return growSelection(s);
            case 3:
                return shrinkSelection(s);
            case 4:
                return void(storeSelection(s, QString::number(below(3))));
            case 5:
                return recallSelection(s, QString::number(below(3)), SelectMode(below(4)));
            case 6:
                return void(removeStoredSelection(s, QString::number(below(3))));
            case 7:
                return s.history().undo();
            case 8:
                return s.history().redo();
            case 9:
                return void(setFlag(s, PatchFlag(below(3)), true));
            case 10:
                return void(clearFlag(s, PatchFlag(below(3))));
            case 11:
                return void(recolourSelection(s, "Shift",
                                              ColourShift{360 * unit(), .5 + unit(), .2 * unit() - .1},
                                              {.featherPx = below(2) == 0 ? 0 : 8 * unit()}));
            case 12:
                return void(below(2) == 0 ? resetColours(s) : resetShape(s));
            case 13:
                return void(makeNow(s, setFeature(s, below(2) == 0)));
            case 14:
                return void(applyEdit(s, "Blur", [&](PatchMesh& mesh) {
                    return setBlur(mesh, s.selection().curves(), 3 * unit(), 3 * unit());
                }));
            case 15:
                // Few, so that the mesh does not grow without end.
                if (s.selection().patches().size() < 3) (void)makeNow(s, splitPatches(s));
                return;
            case 16:
                return void(below(2) == 0 ? makeNow(s, splitCurves(s)) : makeNow(s, mergeCurves(s)));
            default:
                return void(makeNow(s, snapToFeature(s)));
        }
    }

    std::mt19937 mRandom;
    std::unique_ptr<DocumentSession> mSession;
    ToolManager mTools;
    glm::dvec2 mPoint{0, 0};
};

class RandomSessionTest : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomSessionTest, StaysSoundAndCanBeUndone) {
    constexpr int kSteps = 2500, kStepsToACheck = 250;
    const unsigned seed = GetParam();
    std::printf("seed %u\n", seed);
    RandomSession random(seed);
    DocumentSession& session = random.session();
    const auto start = testing::bytesOf(session.document());
    int steps = 0;
    QObject::connect(&session, &DocumentSession::changed,
                     [&](const Change& change) { steps += change.mesh() && !change.preview; });
    for (int i = 0; i < kSteps; ++i) {
        random.step();
        QCoreApplication::processEvents();
        if (i % kStepsToACheck != 0) continue;
        const MeshValidation validation = validate(session.document().mesh);
        ASSERT_TRUE(validation.valid()) << "after step " << i << ": " << validation.violations.front();
    }
    random.endGesture();
    QCoreApplication::processEvents();
    EXPECT_FALSE(session.editing());
    const MeshValidation validation = validate(session.document().mesh);
    EXPECT_TRUE(validation.valid()) << validation.violations.front();
    EXPECT_GT(steps, kSteps / 50) << "the session did next to nothing";
    EXPECT_FALSE(session.history().forgot());
    const auto end = testing::bytesOf(session.document());
    const int last = session.history().index();
    session.history().goTo(0);
    EXPECT_EQ(testing::bytesOf(session.document()), start);
    session.history().goTo(last);
    EXPECT_EQ(testing::bytesOf(session.document()), end);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSessionTest, ::testing::Values(1u, 2u, 3u, 4u));

}  // namespace
}  // namespace tessera
