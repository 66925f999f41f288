// The tools as state machines: what events make of selection, document, options and view.
#include <gtest/gtest.h>

#include <QSignalSpy>
#include <QTest>

#include "app/edit_actions.h"
#include "app/selection_actions.h"
#include "app/tools/blur_tool.h"
#include "app/tools/colour_at.h"
#include "app/tools/tool_manager.h"
#include "core/edit/edge_edits.h"
#include "core/edit/recolour.h"
#include "core/image/oklab.h"
#include "core/mesh/mesh_validate.h"
#include "tests/support/edits.h"
#include "tests/support/painted_image.h"
#include "tests/support/test_meshes.h"
#include "tests/support/tool_events.h"

namespace tessera {
namespace {

constexpr int kWidth = 120, kHeight = 90;

// 6 x 4 straight cells of two patches each; the first columns of one colour, the others of another, with a
// feature between them.
PatchMesh twoParts(uint32_t columns) {
    PatchMesh mesh = testing::gridMesh(kWidth, kHeight, 6, 4);
    const HalfedgeMesh& c = mesh.connectivity();
    const auto left = [columns](PatchId p) { return p.index % 12 < 2 * columns; };
    mesh.forEachPatch([&](PatchId p) {
        const std::array colour = left(p) ? std::array{.8f, .3f, .2f} : std::array{.2f, .3f, .8f};
        mesh.setSpline(p, constantSpline(colour));
    });
    mesh.forEachEdge([&](EdgeId e) {
        if (c.onBorder(e)) return;
        EdgeCurve curve = mesh.curve(e);
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        curve.feature = left(c.face(h)) != left(c.face(HalfedgeMesh::twin(h)));
        mesh.setCurve(e, curve);
    });
    return mesh;
}

struct ToolsTest : ::testing::Test {
    ToolsTest() {
        Document document;
        document.mesh = twoParts(3);
        session = std::make_unique<DocumentSession>(document, Photo{}, QString());
        tools.setSession(session.get());
    }
    ~ToolsTest() override { tools.setSession(nullptr); }

    const PatchMesh& mesh() const { return session->document().mesh; }
    const PatchSet& selected() const { return session->selection().patches(); }
    History& history() { return session->history(); }
    std::vector<uint8_t> bytes() const { return testing::bytesOf(session->document()); }
    PatchId patchAt(glm::dvec2 point) { return session->query().patchAt(point).value().patch; }
    // The inner vertex at column i, row j of the grid.
    static VertexId vertex(uint32_t i, uint32_t j) { return VertexId(j * 7 + i); }
    glm::dvec2 place(VertexId v) const { return toPixels(mesh().position(v)); }

    std::unique_ptr<DocumentSession> session;
    ToolManager tools;
    testing::Pointer pointer{tools};
};

TEST_F(ToolsTest, Constrained) {
    EXPECT_NEAR(glm::distance(constrainedTo45({10, 1}), {10, 0}), 0, 1e-12);
    EXPECT_NEAR(glm::distance(constrainedTo45({-7, 8}), {-7.5, 7.5}), 0, 1e-12);
    EXPECT_EQ(constrainedTo45({0, 0}), glm::dvec2(0));
}

TEST_F(ToolsTest, ClicksSelectPatches) {
    const glm::dvec2 a(25, 25), b(95, 70);
    pointer.click(a);
    EXPECT_EQ(selected(), PatchSet{patchAt(a)});
    pointer.modifiers.shift = true;
    pointer.click(b);
    EXPECT_EQ(selected().size(), 2u);
    pointer.modifiers = {.alt = true};
    pointer.click(a);
    EXPECT_EQ(selected(), PatchSet{patchAt(b)});
    pointer.modifiers = {};
    pointer.click({-5, 10});
    EXPECT_TRUE(selected().empty()) << "a click beside the picture";
}

// As while a job edits many elements.
TEST_F(ToolsTest, SayThatAnotherChangeIsUnderWay) {
    QString said;
    QObject::connect(&tools, &ToolManager::said, [&](const QString& text) { said = text; });
    session->selection().setPatches({patchAt({25, 25})});
    EditSession other(*session, "Other");
    for (const ToolId tool :
         {ToolId::Brush, ToolId::DragColour, ToolId::Gradient, ToolId::Blur, ToolId::Direct}) {
        said.clear();
        tools.setTool(tool);
        pointer.drag(place(vertex(3, 2)), {70, 70});
        EXPECT_TRUE(said.contains("under way")) << "tool " << int(tool);
        EXPECT_EQ(history().count(), 0);
    }
}

TEST_F(ToolsTest, AMarqueeSelectsAsItGrows) {
    pointer.press({1, 1});
    pointer.move({41, 44});
    ASSERT_TRUE(tools.overlay().marquee.has_value());
    EXPECT_EQ(tools.overlay().marquee->max, glm::dvec2(41, 44));
    EXPECT_EQ(selected().size(), 8u) << "2 x 2 cells";
    pointer.move({119, 89});
    EXPECT_EQ(selected().size(), 48u);
    tools.keyPress({ToolKeyCode::Escape});
    EXPECT_TRUE(selected().empty()) << "Escape gives back what was selected";
    EXPECT_FALSE(tools.active());
    pointer.release({119, 89});
    EXPECT_TRUE(selected().empty()) << "the release of a gesture that is over";
}

TEST_F(ToolsTest, ADoubleClickSelectsWhatFeaturesEnclose) {
    pointer.doubleClick({25, 25});
    EXPECT_EQ(selected().size(), 24u);
    pointer.modifiers.shift = true;
    pointer.doubleClick({95, 70});
    EXPECT_EQ(selected().size(), 48u);
    pointer.modifiers = {.alt = true};
    pointer.doubleClick({95, 70});
    EXPECT_EQ(selected().size(), 24u);
    EXPECT_TRUE(contains(selected(), patchAt({25, 25})));
}

TEST_F(ToolsTest, ADoubleClickThatFindsMostOfThePictureSaysSo) {
    QString said;
    QObject::connect(&tools, &ToolManager::said, [&](const QString& text) { said = text; });
    pointer.doubleClick({25, 25});
    EXPECT_EQ(said, QString()) << "one half";
    Document document;
    document.mesh = twoParts(4);
    DocumentSession uneven(document, Photo{}, QString());
    tools.setSession(&uneven);
    pointer.doubleClick({115, 25});
    EXPECT_EQ(uneven.selection().patches().size(), 16u);
    EXPECT_EQ(said, QString()) << "the smaller part";
    pointer.doubleClick({25, 25});
    EXPECT_EQ(uneven.selection().patches().size(), 32u);
    EXPECT_TRUE(said.contains("most of the picture")) << said.toStdString();
    tools.setSession(nullptr);
}

TEST_F(ToolsTest, ALockedPatchIsPassedOverAndSaysSo) {
    const PatchId locked = patchAt({25, 25});
    session->selection().setPatches({locked});
    ASSERT_TRUE(setFlag(*session, PatchFlag::Locked, true));
    QString said;
    QObject::connect(&tools, &ToolManager::said, [&](const QString& text) { said = text; });
    for (const ToolId id : {ToolId::Select, ToolId::Wand}) {
        tools.setTool(id);
        pointer.move({25, 25});
        ASSERT_TRUE(tools.overlay().lock.has_value());
        EXPECT_EQ(tools.overlay().lock->patch, locked);
        pointer.press({25, 25});
        pointer.release({25, 25});
        EXPECT_TRUE(said.startsWith("This patch is locked")) << said.toStdString();
        EXPECT_TRUE(selected().empty());
        said.clear();
        pointer.move({95, 70});
        EXPECT_FALSE(tools.overlay().lock.has_value());
    }
}

TEST_F(ToolsTest, TheLassoIsAPolygon) {
    tools.setTool(ToolId::Lasso);
    pointer.press({-10, -10});
    for (const glm::dvec2 corner : {glm::dvec2(62, -10), glm::dvec2(62, 100), glm::dvec2(-10, 100)})
        pointer.move(corner);
    EXPECT_EQ(tools.overlay().lasso.size(), 4u);
    pointer.release({-10, 100});
    EXPECT_EQ(selected().size(), 24u) << "the left half";
    EXPECT_TRUE(tools.overlay().lasso.empty());
}

TEST_F(ToolsTest, TheWandSelectsByColour) {
    tools.setTool(ToolId::Wand);
    pointer.click({25, 25});
    EXPECT_EQ(selected().size(), 24u);
    pointer.modifiers.shift = true;
    pointer.click({95, 70});
    EXPECT_EQ(selected().size(), 48u);
}

TEST_F(ToolsTest, LockedAndHiddenPatchesAreNotSelected) {
    PatchMesh locked = mesh();
    locked.setAttributes(patchAt({25, 25}), {.locked = true});
    const auto edit = [&](PatchMesh& m) {
        m = locked;
        return touchedOf({}, {}, {patchAt({25, 25})});
    };
    ASSERT_TRUE(applyEdit(*session, "Lock", edit));
    pointer.click({25, 25});
    EXPECT_TRUE(selected().empty());
    pointer.drag({1, 1}, {119, 89});
    EXPECT_EQ(selected().size(), 47u);
}

TEST_F(ToolsTest, AVertexIsDragged) {
    tools.setTool(ToolId::Direct);
    const VertexId v = vertex(2, 2);
    const glm::dvec2 from = place(v);
    const auto start = bytes();
    pointer.press(from + 1.);
    pointer.move(from + glm::dvec2(6, 3) + 1.);
    EXPECT_TRUE(session->editing());
    EXPECT_EQ(place(v), from + glm::dvec2(6, 3));
    pointer.release(from + glm::dvec2(6, 3) + 1.);
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(history().count(), 1);
    EXPECT_EQ(session->selection().points(), std::vector{ControlPointRef::of(v)});
    EXPECT_TRUE(validate(mesh()).valid());
    const auto moved = bytes();
    history().undo();
    EXPECT_EQ(bytes(), start);
    history().redo();
    EXPECT_EQ(bytes(), moved);
}

// Colours are fitted anew where they were the photo's, even those that never came near it, and stay where a
// person has changed them, even by little.
TEST_F(ToolsTest, AReshapeTakesNoRecolouringBack) {
    const auto relink = [&](float red, float perX) {
        const auto colour = [=](double x, double, int c) {
            return c == 0 ? double(red) + double(perX) * x : c == 1 ? .3 : .2;
        };
        session->relinkPhoto(
            {std::make_shared<const Image>(testing::paint(kWidth, kHeight, 3, colour)), nullptr, nullptr},
            {});
    };
    tools.setTool(ToolId::Direct);
    const VertexId v = vertex(1, 2);
    const glm::dvec2 from = place(v), to = from + glm::dvec2(6, 3), probe = from + glm::dvec2(-4, 1);
    const auto red = [&] { return colourAt(*session, probe, ColourSource::Vector).value().x; };
    relink(.5f, .004f);
    pointer.drag(from, to);
    EXPECT_NEAR(red(), .5 + .004 * probe.x, .02) << "it was .8 as it was vectorized";
    history().undo();
    ASSERT_NEAR(red(), .8, 1e-6);

    relink(.8f, 0);
    ASSERT_TRUE(applyEdit(*session, "Levels",
                          [](PatchMesh& m) { return recolour(m, allSelectable(m), Levels{.05, 0}); }));
    ASSERT_NEAR(red(), .85, 1e-6);
    pointer.drag(from, to);
    EXPECT_EQ(place(v), to);
    EXPECT_NEAR(red(), .85, 1e-6);
}

TEST_F(ToolsTest, ADragIsHeldByTheCertificate) {
    tools.setTool(ToolId::Direct);
    const VertexId v = vertex(2, 2);
    const glm::dvec2 from = place(v), far = from + glm::dvec2(45, 2);
    pointer.press(from);
    pointer.move(far);
    EXPECT_LT(place(v).x, far.x - 10);
    EXPECT_TRUE(tools.overlay().blocking.has_value());
    EXPECT_TRUE(validate(mesh()).valid());
    pointer.move(from + glm::dvec2(2, 0));
    EXPECT_FALSE(tools.overlay().blocking.has_value());
    EXPECT_EQ(place(v), from + glm::dvec2(2, 0));
    tools.keyPress({ToolKeyCode::Escape});
    EXPECT_EQ(place(v), from);
    EXPECT_EQ(history().count(), 0);
}

TEST_F(ToolsTest, ShiftConstrainsADrag) {
    tools.setTool(ToolId::Direct);
    const VertexId v = vertex(2, 2);
    const glm::dvec2 from = place(v);
    pointer.press(from);
    pointer.modifiers.shift = true;
    pointer.move(from + glm::dvec2(6, 1));
    EXPECT_EQ(place(v), from + glm::dvec2(6, 0));
    pointer.release(from + glm::dvec2(6, 1));
}

TEST_F(ToolsTest, AClickSelectsPointsAndTheirHandlesCanBeDragged) {
    tools.setTool(ToolId::Direct);
    const VertexId v = vertex(2, 2);
    pointer.click(place(v));
    EXPECT_EQ(session->selection().points(), std::vector{ControlPointRef::of(v)});
    const ToolOverlay overlay = tools.overlay();
    EXPECT_EQ(overlay.handles.size(), 7u) << "the vertex and a handle for each of its six curves";
    EXPECT_EQ(overlay.handleLines.size(), 6u);
    std::optional<HalfedgeId> right;
    mesh().connectivity().forEachOutgoing(v, [&](HalfedgeId h) {
        if (mesh().connectivity().target(h) == vertex(3, 2)) right = h;
    });
    ASSERT_TRUE(right.has_value());
    const auto handle = [&] { return toPixels(mesh().controlPoints(*right)[1]); };
    const glm::dvec2 from = handle();
    pointer.drag(from, from + glm::dvec2(0, 5));
    EXPECT_EQ(handle(), from + glm::dvec2(0, 5));
    EXPECT_EQ(place(v), glm::dvec2(40, 45)) << "the vertex stays";
    EXPECT_EQ(tools.overlay().handles.size(), 6u) << "the handles of the vertex stay in reach";
    pointer.modifiers.shift = true;
    pointer.click(place(v));
    EXPECT_EQ(session->selection().points().size(), 2u);
}

TEST_F(ToolsTest, ACurveIsBentByItself) {
    tools.setTool(ToolId::Direct);
    const HalfedgeId h = mesh().connectivity().find(vertex(2, 2), vertex(3, 2));
    ASSERT_TRUE(h.valid());
    const auto middle = [&] { return toPixels(mesh().controlPoints(h)).at(.5); };
    const glm::dvec2 from = middle();
    pointer.move(from);
    EXPECT_EQ(tools.overlay().hoveredCurve, HalfedgeMesh::edge(h));
    pointer.drag(from, from + glm::dvec2(0, 5));
    EXPECT_LT(glm::distance(middle(), from + glm::dvec2(0, 5)), .02);
    EXPECT_EQ(session->selection().curves(), std::vector{HalfedgeMesh::edge(h)});
    EXPECT_EQ(history().undoText(), "Bend Curve");
}

TEST_F(ToolsTest, ArrowsNudgeInOneStep) {
    tools.setTool(ToolId::Direct);
    const VertexId v = vertex(2, 2);
    const glm::dvec2 from = place(v);
    pointer.click(from);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(tools.keyPress({ToolKeyCode::Right}));
    EXPECT_EQ(place(v), from + glm::dvec2(3, 0));
    EXPECT_EQ(history().count(), 0) << "the key is still down";
    tools.keyRelease({ToolKeyCode::Right});
    EXPECT_EQ(history().count(), 1);
    pointer.pxPerScreenPx = .25;
    pointer.modifiers.alt = true;
    EXPECT_TRUE(pointer.key(ToolKeyCode::Up));
    EXPECT_EQ(place(v), from + glm::dvec2(3, -.25));
    pointer.modifiers = {.shift = true};
    EXPECT_TRUE(pointer.key(ToolKeyCode::Left));
    EXPECT_EQ(place(v), from + glm::dvec2(-7, -.25));
    tools.keyPress({ToolKeyCode::Left});
    tools.keyPress({ToolKeyCode::Escape});
    EXPECT_EQ(place(v), from + glm::dvec2(-7, -.25)) << "Escape takes back what is under way";
    EXPECT_EQ(history().count(), 3);
    session->selection().clear();
    EXPECT_FALSE(tools.keyPress({ToolKeyCode::Left})) << "nothing to nudge: the canvas may scroll";
}

TEST_F(ToolsTest, NudgesInARowAreOneStep) {
    tools.setTool(ToolId::Direct);
    const VertexId v = vertex(2, 2), other = vertex(3, 2);
    const glm::dvec2 from = place(v);
    pointer.click(from);
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(pointer.key(ToolKeyCode::Right));
    EXPECT_TRUE(pointer.key(ToolKeyCode::Left));
    EXPECT_EQ(history().count(), 1);
    const glm::dvec2 moved = place(v);
    EXPECT_EQ(moved, from + glm::dvec2(9, 0));
    history().undo();
    EXPECT_EQ(place(v), from);
    history().redo();
    EXPECT_EQ(place(v), moved);
    // Another direction, other points, another step between, and a state that is in the file.
    pointer.key(ToolKeyCode::Down);
    EXPECT_EQ(history().count(), 2);
    pointer.click(place(other));
    pointer.key(ToolKeyCode::Down);
    EXPECT_EQ(history().count(), 3);
    session->markSaved(session->revision(), "/folder/a.tessera", {});
    pointer.key(ToolKeyCode::Down);
    EXPECT_EQ(history().count(), 4);
    EXPECT_EQ(history().savedIndex(), 3);
    session->selection().setPatches({patchAt({25, 25})});
    ASSERT_TRUE(
        applyEdit(*session, "Paint", [](PatchMesh& mesh) { return testing::paint(mesh, PatchId(0), .5f); }));
    session->selection().setShape({ControlPointRef::of(other)}, {});
    pointer.key(ToolKeyCode::Down);
    EXPECT_EQ(history().count(), 6);
}

TEST_F(ToolsTest, ANudgeAfterAPauseIsAnotherStep) {
    tools.setTool(ToolId::Direct);
    pointer.click(place(vertex(2, 2)));
    pointer.key(ToolKeyCode::Right);
    QTest::qWait(1100);
    pointer.key(ToolKeyCode::Right);
    EXPECT_EQ(history().count(), 2);
}

TEST_F(ToolsTest, AMarqueeSelectsVertices) {
    tools.setTool(ToolId::Direct);
    // Clear of curves and points.
    pointer.drag({34, 8}, {75, 53});
    EXPECT_EQ(session->selection().points().size(), 4u);
}

TEST_F(ToolsTest, TheEyedropperPicks) {
    tools.setTool(ToolId::Eyedropper);
    pointer.move({25, 25});
    ASSERT_TRUE(tools.overlay().swatch.has_value());
    pointer.click({25, 25});
    EXPECT_NEAR(glm::distance(tools.options().colour, {.8, .3, .2}), 0, 1e-6);
    session->selection().setPatches({patchAt({95, 70})});
    pointer.modifiers.shift = true;
    pointer.click({25, 25});
    EXPECT_EQ(history().undoText(), "Replace Colour");
    EXPECT_NEAR(glm::distance(*colourAt(*session, {95, 70}, ColourSource::Vector), {.8, .3, .2}), 0, 1e-3);
    EXPECT_FALSE(colourAt(*session, {95, 70}, ColourSource::Original).has_value()) << "there is no photo";
    EXPECT_FALSE(colourAt(*session, {-1, 70}, ColourSource::Vector).has_value());
}

TEST_F(ToolsTest, TheEyedropperPicksFromTheOriginalToo) {
    auto image = std::make_shared<const Image>(
        testing::paint(kWidth, kHeight, 3, [](double, double, int c) { return c == 0 ? .5 : .25; }));
    session->relinkPhoto({image, nullptr, nullptr}, {});
    tools.setTool(ToolId::Eyedropper);
    pointer.modifiers.alt = true;
    pointer.click({25, 25});
    EXPECT_NEAR(glm::distance(tools.options().colour, {.5, .25, .25}), 0, 1e-6);
    pointer.modifiers = {};
    pointer.click({25, 25});
    EXPECT_NEAR(glm::distance(tools.options().colour, {.8, .3, .2}), 0, 1e-6);
    // What is seen is what is picked: O is held.
    const ToolEvent onPhoto{.point = {25, 25}, .onPhoto = true};
    tools.press(onPhoto);
    tools.release(onPhoto);
    EXPECT_NEAR(glm::distance(tools.options().colour, {.5, .25, .25}), 0, 1e-6);
}

TEST_F(ToolsTest, AStrokeIsOneStep) {
    tools.setTool(ToolId::Brush);
    ToolOptions options = tools.options();
    options.colour = {0, 1, 0};
    options.brushRadiusPx = 12;
    options.brushKeepsShading = false;
    tools.setOptions(options);
    const auto start = bytes();
    pointer.press({30, 30});
    ASSERT_TRUE(tools.overlay().ring.has_value());
    EXPECT_EQ(tools.overlay().ring->radiusPx, 12);
    pointer.move({50, 30});
    EXPECT_GT(colourAt(*session, {40, 30}, ColourSource::Vector)->y, .7);
    pointer.release({50, 40});
    EXPECT_EQ(history().count(), 1);
    history().undo();
    EXPECT_EQ(bytes(), start);
    pointer.press({30, 30});
    tools.cancel();
    EXPECT_EQ(bytes(), start);
    EXPECT_EQ(history().count(), 1);
}

TEST_F(ToolsTest, ColoursAreDragged) {
    tools.setTool(ToolId::DragColour);
    const glm::dvec2 red(25, 25), blue(95, 70);
    pointer.drag(red, blue);
    EXPECT_NEAR(glm::distance(*colourAt(*session, blue, ColourSource::Vector), {.8, .3, .2}), 0, 2. / 255);
    EXPECT_NEAR(glm::distance(*colourAt(*session, red, ColourSource::Vector), {.8, .3, .2}), 0, 1e-6);
    EXPECT_EQ(history().count(), 1);
    ToolOptions options = tools.options();
    options.colour = {0, 0, 0};
    tools.setOptions(options);
    pointer.click(red);
    EXPECT_NEAR(glm::length(*colourAt(*session, red, ColourSource::Vector)), 0, 2. / 255);
    EXPECT_EQ(history().count(), 2);
}

TEST_F(ToolsTest, AGradientRunsAcrossTheSelection) {
    tools.setTool(ToolId::Gradient);
    QSignalSpy said(&tools, &ToolManager::said);
    pointer.drag({0, 45}, {120, 45});
    EXPECT_EQ(said.size(), 1) << "nothing is selected";
    EXPECT_EQ(history().count(), 0);
    selectAll(*session);
    ToolOptions options = tools.options();
    options.colour = {0, 0, 0};
    options.secondColour = {1, 1, 1};
    tools.setOptions(options);
    pointer.press({0, 45});
    pointer.modifiers.shift = true;
    pointer.move({120, 50});
    ASSERT_TRUE(tools.overlay().gradient.has_value());
    EXPECT_NEAR(tools.overlay().gradient->line.to.y, 45, 1e-9);
    pointer.release({120, 50});
    EXPECT_EQ(history().count(), 1);
    for (const double x : {10., 50., 110.})
        EXPECT_NEAR(colourAt(*session, {x, 33}, ColourSource::Vector)->x, x / 120, .02);
}

TEST_F(ToolsTest, TheBlurHandleSoftens) {
    tools.setTool(ToolId::Blur);
    const HalfedgeId h = mesh().connectivity().find(vertex(3, 1), vertex(3, 2));
    ASSERT_TRUE(h.valid());
    const EdgeId e = HalfedgeMesh::edge(h);
    EXPECT_EQ(wholeFeature(mesh(), e).size(), 4u);
    const auto sigma = [&](EdgeId edge) { return mesh().curve(edge).blurSigma; };
    pointer.move({60, 33});
    EXPECT_EQ(tools.overlay().handles.size(), 2u);
    pointer.drag({62, 33}, {68, 33});
    for (const EdgeId edge : wholeFeature(mesh(), e)) EXPECT_NEAR(sigma(edge)[0], 2, .01);
    EXPECT_EQ(history().count(), 1);
    pointer.drag({66, 33}, {52, 33});
    EXPECT_NEAR(sigma(e)[0], 2 + 2. / 3, .01) << "the distance counts, on whichever side";
    pointer.drag({66, 33}, {60, 33});
    EXPECT_NEAR(sigma(e)[1], 2. / 3, .01);
    ToolOptions options = tools.options();
    options.wholeFeatures = false;
    tools.setOptions(options);
    history().goTo(0);
    pointer.drag({62, 33}, {68, 33});
    int soft = 0;
    for (const EdgeId edge : wholeFeature(mesh(), e)) soft += sigma(edge)[0] > 0 || sigma(edge)[1] > 0;
    EXPECT_EQ(soft, 1);
}

TEST_F(ToolsTest, TheBlurHandleStopsWhereThereIsNoMoreRoom) {
    const HalfedgeId h = mesh().connectivity().find(vertex(3, 1), vertex(3, 2));
    {
        // Another feature 20 px beside it.
        EditSession edit(*session, "Mark");
        ASSERT_TRUE(edit.preview([](PatchMesh& m) {
            std::vector<EdgeId> column;
            for (uint32_t j = 0; j < 4; ++j)
                column.push_back(HalfedgeMesh::edge(m.connectivity().find(vertex(4, j), vertex(4, j + 1))));
            return setFeature(m, column, true);
        }));
        edit.commit();
    }
    QString said;
    QObject::connect(&tools, &ToolManager::said, [&](const QString& text) { said = text; });
    tools.setTool(ToolId::Blur);
    const auto sigma = [&] { return mesh().curve(HalfedgeMesh::edge(h)).blurSigma; };
    pointer.drag({62, 33}, {70, 33});
    EXPECT_NEAR(sigma()[0], 8. / 3, .01);
    EXPECT_TRUE(said.isEmpty()) << said.toStdString();
    pointer.drag({68, 33}, {10, 33});
    EXPECT_NEAR(sigma()[0], 20. / 3, .01);
    EXPECT_NEAR(sigma()[1], 20. / 3, .01);
    EXPECT_TRUE(said.contains("too near")) << said.toStdString();
}

TEST_F(ToolsTest, HandAndZoomAskForViews) {
    std::vector<ViewRequest> asked;
    QObject::connect(&tools, &ToolManager::viewRequested,
                     [&](const ViewRequest& request) { asked.push_back(request); });
    tools.setTool(ToolId::Hand);
    EXPECT_EQ(tools.cursor(), ToolCursor::OpenHand);
    pointer.press({10, 10});
    EXPECT_EQ(tools.cursor(), ToolCursor::ClosedHand);
    pointer.move({11, 12});
    pointer.release({10, 10});
    ASSERT_EQ(asked.size(), 1u);
    EXPECT_EQ(std::get<PanBy>(asked[0]).offset, glm::dvec2(1, 2));
    tools.setTool(ToolId::Zoom);
    pointer.click({30, 40});
    pointer.modifiers.alt = true;
    pointer.click({30, 40});
    pointer.modifiers = {};
    pointer.drag({10, 20}, {50, 40});
    ASSERT_EQ(asked.size(), 4u);
    EXPECT_TRUE(std::get<ZoomStep>(asked[1]).in);
    EXPECT_FALSE(std::get<ZoomStep>(asked[2]).in);
    EXPECT_EQ(std::get<ShowRect>(asked[3]).rect.max, glm::dvec2(50, 40));
    EXPECT_EQ(history().count(), 0);
}

TEST_F(ToolsTest, AnotherToolOrDocumentEndsAGesture) {
    const auto start = bytes();
    tools.setTool(ToolId::Direct);
    pointer.press(place(vertex(2, 2)));
    pointer.move(place(vertex(2, 2)) + 5.);
    tools.setTool(ToolId::Select);
    EXPECT_FALSE(session->editing());
    EXPECT_EQ(bytes(), start);
    tools.setTool(ToolId::Direct);
    pointer.press(place(vertex(2, 2)));
    pointer.move(place(vertex(2, 2)) + 5.);
    DocumentSession photoOnly({}, {}, {}, {});
    tools.setSession(&photoOnly);
    EXPECT_EQ(bytes(), start);
    pointer.click({10, 10});
    EXPECT_FALSE(tools.usable(ToolId::Direct)) << "there are no patches";
    EXPECT_TRUE(tools.usable(ToolId::Zoom));
    tools.setSession(nullptr);
    pointer.click({10, 10});
    EXPECT_FALSE(tools.keyPress({ToolKeyCode::Escape}));
}

TEST_F(ToolsTest, APanelsGestureKeepsToolsFromTheirs) {
    tools.setTool(ToolId::Direct);
    const glm::dvec2 from = place(vertex(2, 2));
    EditSession slider(*session, "Slider");
    pointer.drag(from, from + 5.);
    pointer.click(from);
    EXPECT_TRUE(tools.keyPress({ToolKeyCode::Left}));
    EXPECT_EQ(place(vertex(2, 2)), from);
    for (const ToolId id : {ToolId::Brush, ToolId::DragColour, ToolId::Gradient, ToolId::Blur}) {
        tools.setTool(id);
        pointer.drag({55, 30}, {70, 40});
        pointer.click({55, 30});
    }
    EXPECT_TRUE(slider.open());
    slider.cancel();
    EXPECT_EQ(history().count(), 0);
}

}  // namespace
}  // namespace tessera
