// Exports of any size and format, and how they end early.
#include <gtest/gtest.h>

#include <QImage>
#include <QTest>

#include "app/jobs/export_job.h"
#include "tests/support/edits.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_meshes.h"

namespace tessera {
namespace {

class ExportTest : public testing::TemporaryFolderTest {
  protected:
    // Runs the job to its end; what went wrong, if anything.
    std::optional<Error> run(ExportRequest request, const std::string& name,
                             const std::function<void(Job&)>& meanwhile = {}) {
        request.path = QString::fromStdString(at(name));
        std::optional<Result<Exported>> outcome;
        Job* job =
            startExportJob(&mOwner, mMesh, request, [&](Result<Exported> result) { outcome = result; });
        if (meanwhile) meanwhile(*job);
        EXPECT_TRUE(QTest::qWaitFor([&] { return outcome.has_value(); }, 60'000));
        if (!outcome || outcome->has_value()) return {};
        return outcome->error();
    }
    Image read(const std::string& name) { return readImage(at(name)).value().image; }

    QObject mOwner;
    PatchMesh mMesh = testing::curvedMesh(64, 48, 4, 3, 7);
};

TEST(ExportSize, OfAScaleOrAsAsked) {
    EXPECT_EQ(exportSize({64, 48}, {.path = {}, .scale = 2.5}), QSize(160, 120));
    EXPECT_EQ(exportSize({64, 48}, {.path = {}, .scale = .001}), QSize(1, 1));
    EXPECT_EQ(exportSize({64, 48}, {.path = {}, .size = {100, 20}}), QSize(100, 20));
}

TEST_F(ExportTest, WritesWhatTheRendererDraws) {
    for (const int samples : {1, 4, 16}) {
        EXPECT_FALSE(
            run({.path = {}, .scale = 2, .samples = samples, .options = {.bitsPerChannel = 16}}, "a.png"));
        const Image drawn = rasterize(mMesh, wholePicture(mMesh, {2, 2}), {.samples = samples}).value();
        const Image written = read("a.png");
        ASSERT_EQ(written.width(), 128);
        for (int c = 0; c < 3; ++c)
            for (size_t i = 0; i < drawn.planeSize(); ++i)
                ASSERT_NEAR(written.plane(c)[i], std::clamp(drawn.plane(c)[i], 0.f, 1.f), 1e-5f);
    }
}

TEST_F(ExportTest, AnySizeAndFormat) {
    for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr"}) {
        EXPECT_FALSE(run({.path = {}, .size = {90, 100}}, name)) << name;
        EXPECT_EQ(read(name).width(), 90) << name;
        EXPECT_EQ(read(name).height(), 100) << name;
    }
}

TEST_F(ExportTest, TransparencyIsKeptOrFilled) {
    mMesh = testing::gridMesh(64, 48, 4, 3, 4);  // all transparent
    mMesh.setSpline(PatchId(5), constantSpline(std::array{.5f, .25f, .5f, 1.f}));
    EXPECT_FALSE(run({.path = {}}, "a.png"));
    const Image transparent = read("a.png");
    ASSERT_EQ(transparent.channels(), 4);
    EXPECT_FALSE(run({.path = {}, .options = {.background = std::array{0.f, 1.f, 0.f}}}, "b.png"));
    const Image filled = read("b.png");
    ASSERT_EQ(filled.channels(), 3);
    size_t holes = 0;
    for (size_t i = 0; i < filled.planeSize(); ++i) {
        if (transparent.plane(3)[i] > 0) continue;
        ++holes;
        ASSERT_EQ(filled.plane(1)[i], 1);
        ASSERT_EQ(filled.plane(0)[i], 0);
    }
    EXPECT_GT(holes, filled.planeSize() / 2);
    EXPECT_LT(holes, filled.planeSize());
}

TEST_F(ExportTest, StopsAndLeavesNothing) {
    const auto error = run({.path = {}, .scale = 80}, "a.png", [](Job& job) { job.stop(); });
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code, ErrorCode::Stopped);
    EXPECT_TRUE(std::filesystem::is_empty(mFolder));
}

TEST_F(ExportTest, RefusesWhatIsTooLarge) {
    const auto error = run({.path = {}, .scale = 1e9}, "a.png");
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code, ErrorCode::Usage);
}

}  // namespace
}  // namespace tessera
