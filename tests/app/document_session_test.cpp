// Undo, redo and the modified state of a document.
#include "app/document_session.h"

#include <gtest/gtest.h>

#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

Document documentWith(int columns, unsigned seed) {
    Document document;
    document.mesh = testing::curvedMesh(64, 48, columns, 3, seed);
    document.settings.patches = columns * 6;
    document.report.shortfall = std::to_string(seed);
    return document;
}

// All that one can see of a mesh.
void expectSame(const Document& a, const Document& b) {
    ASSERT_EQ(a.mesh.patchCount(), b.mesh.patchCount());
    ASSERT_EQ(a.mesh.width(), b.mesh.width());
    a.mesh.forEachPatch([&](PatchId p) {
        EXPECT_EQ(a.mesh.controlPoints(p).p, b.mesh.controlPoints(p).p);
        EXPECT_EQ(a.mesh.spline(p), b.mesh.spline(p));
    });
    a.mesh.forEachEdge([&](EdgeId e) { EXPECT_EQ(a.mesh.curve(e), b.mesh.curve(e)); });
    EXPECT_EQ(a.settings, b.settings);
    EXPECT_EQ(a.report, b.report);
    EXPECT_EQ(a.colourStep, b.colourStep);
}

struct DocumentSessionTest : ::testing::Test {
    void replaceBy(Document document) {
        session.history().push(EditCommand(session, "Vectorize", std::move(document), {.replaced = true}));
    }

    DocumentSession session{documentWith(4, 1), {}, "/folder/old.tessera"};
};

TEST_F(DocumentSessionTest, UndoAndRedoGiveTheSameStates) {
    const Document before = session.document();
    const uint64_t first = session.revision();
    replaceBy(documentWith(7, 2));
    const Document after = session.document();
    const uint64_t second = session.revision();
    EXPECT_NE(first, second);
    expectSame(after, documentWith(7, 2));
    for (int i = 0; i < 3; ++i) {
        session.history().undo();
        expectSame(session.document(), before);
        EXPECT_EQ(session.revision(), first);
        session.history().redo();
        expectSame(session.document(), after);
        EXPECT_EQ(session.revision(), second);
    }
}

TEST_F(DocumentSessionTest, AStateNeverGetsTheRevisionOfAnother) {
    const uint64_t first = session.revision();
    replaceBy(documentWith(7, 2));
    const uint64_t second = session.revision();
    session.history().undo();
    replaceBy(documentWith(5, 3));
    EXPECT_NE(session.revision(), first);
    EXPECT_NE(session.revision(), second);
}

TEST_F(DocumentSessionTest, ModifiedMeansNotTheSavedState) {
    EXPECT_FALSE(session.modified());
    replaceBy(documentWith(7, 2));
    EXPECT_TRUE(session.modified());
    session.history().undo();
    EXPECT_FALSE(session.modified());
    session.history().redo();
    session.markSaved(session.revision(), "/folder/new.tessera", .001);
    EXPECT_FALSE(session.modified());
    EXPECT_EQ(session.displayName(), "new.tessera");
    EXPECT_EQ(session.document().colourStep, .001);
    session.history().undo();
    EXPECT_TRUE(session.modified());
}

TEST_F(DocumentSessionTest, WhatChangedWhileItWasSavedStaysModified) {
    replaceBy(documentWith(7, 2));
    const uint64_t snapshot = session.revision();
    replaceBy(documentWith(5, 3));
    session.markSaved(snapshot, "/folder/new.tessera", .001);
    EXPECT_TRUE(session.modified());
    EXPECT_FALSE(session.document().colourStep.has_value());
    session.history().undo();
    EXPECT_FALSE(session.modified());
}

TEST_F(DocumentSessionTest, OneSignalForOneStep) {
    int meshChanges = 0;
    QObject::connect(&session, &DocumentSession::changed,
                     [&](const Change& change) { meshChanges += change.mesh() ? 1 : 0; });
    replaceBy(documentWith(7, 2));
    EXPECT_EQ(meshChanges, 1);
    session.history().undo();
    EXPECT_EQ(meshChanges, 2);
}

TEST_F(DocumentSessionTest, SuggestsNamesBesideTheFile) {
    EXPECT_EQ(session.suggestedPath("png"), "/folder/old.png");
    const DocumentSession photo({}, {.path = "/photos/cat.small.jpg"}, {});
    EXPECT_EQ(photo.suggestedPath("tessera"), "/photos/cat.small.tessera");
    EXPECT_EQ(photo.displayName(), "cat.small.jpg");
}

TEST_F(DocumentSessionTest, SuggestsNoNameThatWouldReplaceThePhoto) {
    const DocumentSession photo({}, {.path = "/photos/cat.PNG"}, {});
    EXPECT_EQ(photo.suggestedPath("png"), "/photos/cat-vector.png");
    EXPECT_EQ(photo.suggestedPath("jpg"), "/photos/cat.jpg");
    const DocumentSession saved({}, {.path = "/photos/cat.png"}, "/photos/cat.tessera");
    EXPECT_EQ(saved.suggestedPath("png"), "/photos/cat-vector.png");
    const DocumentSession elsewhere({}, {.path = "/photos/cat.png"}, "/work/cat.tessera");
    EXPECT_EQ(elsewhere.suggestedPath("png"), "/work/cat.png");
}

}  // namespace
}  // namespace tessera
