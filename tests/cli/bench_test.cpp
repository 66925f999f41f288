// `tessera-cli bench` from outside: its tables, its figures, what it refuses, and that it stops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/image/image_io.h"
#include "tests/support/painted_image.h"
#include "tests/support/temporary_folder.h"

namespace tessera {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

constexpr int kWidth = 72, kHeight = 64;

class Bench : public testing::TemporaryFolderTest {
  protected:
    void SetUp() override {
        TemporaryFolderTest::SetUp();
        fs::create_directories(mFolder / "pictures");
        fs::create_directories(mFolder / "empty");
        save("pictures/disc.png",
             [](double x, double y, int) { return std::clamp(20.5 - std::hypot(x - 36, y - 32), 0., 1.); });
        save("pictures/ramp.png", [](double x, double y, int c) { return (x + (c + 1) * y) / 300; });
        std::ofstream(at("pictures/notes.txt")) << "no picture";
        std::ofstream(at("empty/notes.txt")) << "no picture";
    }

    template <class Value>
    void save(const std::string& name, Value&& value) const {
        const Image image = testing::paint(
            kWidth, kHeight, 3, [&](double x, double y, int c) { return .2 + .6 * double(value(x, y, c)); });
        ASSERT_TRUE(writeImage(image, at(name)));
    }

    // Runs `tessera-cli bench ARGUMENTS` in the folder; its exit code.
    int bench(const std::string& arguments) const { return run("bench " + arguments); }
    int run(const std::string& arguments) const {
        const std::string command =
            "cd '" + mFolder.string() + "' && '" TESSERA_CLI "' " + arguments + " >out 2>err";
        const int status = std::system(command.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    json figures() const { return json::parse(contentOf("figures.json")); }

    void expectError(const std::string& arguments, int exitCode, const std::string& part) const {
        EXPECT_EQ(bench(arguments), exitCode) << arguments;
        EXPECT_THAT(contentOf("err"), AllOf(HasSubstr("tessera-cli: "), HasSubstr(part)));
        EXPECT_EQ(contentOf("out"), "");
    }
};

json rowOf(const json& rows, const std::string& picture, int wanted = 0) {
    for (const json& row : rows)
        if (row["picture"] == picture && (wanted == 0 || row["wanted"] == wanted)) return row;
    ADD_FAILURE() << "no row for " << picture << ", " << wanted;
    return {};
}

size_t linesWith(const std::string& text, const std::string& part) {
    size_t count = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) count += line.find(part) != std::string::npos;
    return count;
}

TEST_F(Bench, TellsEveryFigureOfAFolder) {
    ASSERT_EQ(bench("pictures --methods paper --patches 60,120 --json figures.json"), 0) << contentOf("err");
    const std::string out = contentOf("out");
    for (const char* title : {"Quality\n", "Features\n", "Cost\n"}) EXPECT_THAT(out, HasSubstr(title));
    // Three tables, two counts.
    for (const char* name : {"| disc ", "| ramp ", "| mean "}) EXPECT_EQ(linesWith(out, name), 6u) << out;
    EXPECT_THAT(contentOf("err"), HasSubstr("disc paper 60\n"));

    const json all = figures();
    ASSERT_EQ(all["runs"].size(), 4u);
    for (const json& row : all["runs"]) {
        EXPECT_GT(row["patches"], 10);
        EXPECT_GT(row["psnr"], 20);
        EXPECT_LT(row["mae"], row["euclid"]);
        EXPECT_EQ(row["folds"], 0);
        EXPECT_GE(row["seam_p95"], row["seam_mean"]);
        EXPECT_GT(row["median_angle"], 0);
        EXPECT_LE(row["median_angle"], 60);
        EXPECT_GT(row["cpu_seconds"], 0);
        EXPECT_GT(row["peak_rss_mb"], 5);
        EXPECT_GT(row["bytes"], row["patches"]);
        EXPECT_LT(std::abs(row["codec_loss_db"].get<double>()), .5);
        EXPECT_FALSE(row.contains("peer_cpu_seconds"));
        double stages = 0;
        for (const json& stage : row["stages"]) {
            stages += stage["seconds"].get<double>();
            EXPECT_EQ(stage["seconds"], row["seconds_" + stage["stage"].get<std::string>()]);
        }
        EXPECT_LE(stages, row["seconds"]);
    }
    ASSERT_EQ(all["means"].size(), 2u);
    const json mean = rowOf(all["means"], "mean", 60);
    EXPECT_NEAR(mean["psnr"],
                (rowOf(all["runs"], "disc", 60)["psnr"].get<double>() +
                 rowOf(all["runs"], "ramp", 60)["psnr"].get<double>()) /
                    2,
                1e-9);
    // No JPEG is as good as the ramp: the mean is the disc's.
    const json disc = rowOf(all["runs"], "disc", 60);
    EXPECT_NEAR(disc["bytes_of_jpeg"], disc["bytes"].get<double>() / disc["jpeg_bytes"].get<double>(), 1e-9);
    EXPECT_TRUE(rowOf(all["runs"], "ramp", 60)["bytes_of_jpeg"].is_null());
    EXPECT_EQ(mean["bytes_of_jpeg"], disc["bytes_of_jpeg"]);
    // Nor has the ramp an edge.
    EXPECT_TRUE(rowOf(all["runs"], "ramp", 60)["recall"].is_null());
    EXPECT_EQ(mean["recall"], rowOf(all["runs"], "disc", 60)["recall"]);
}

TEST_F(Bench, AgreesWithTheOtherCommands) {
    ASSERT_EQ(bench("pictures/disc.png --methods paper --patches 60 --json figures.json"), 0);
    const json row = rowOf(figures()["runs"], "disc");
    ASSERT_EQ(run("vectorize pictures/disc.png -o a.tessera --method paper --patches 60 --no-embed --quiet"),
              0);
    ASSERT_EQ(run("render a.tessera -o a.png --samples 4 --quiet"), 0);
    ASSERT_EQ(run("compare pictures/disc.png a.png --json"), 0);
    EXPECT_NEAR(json::parse(contentOf("out"))["psnr"], row["psnr_decoded"], 1e-9);
    ASSERT_EQ(run("validate a.tessera --json"), 0);
    EXPECT_NEAR(json::parse(contentOf("out"))["seam_mean"], row["seam_mean"], .1);
    ASSERT_EQ(run("info a.tessera --json"), 0);
    EXPECT_EQ(json::parse(contentOf("out"))["patches"], row["patches"]);
}

TEST_F(Bench, FindsTheReferenceEdgesInAMeshThatIsCutAlongThem) {
    ASSERT_EQ(bench("pictures/disc.png --methods paper --patches 120 --json figures.json"), 0)
        << contentOf("err");
    const json row = rowOf(figures()["runs"], "disc");
    const double around = 2 * M_PI * 20;
    EXPECT_NEAR(row["reference_px"], around, .15 * around);
    EXPECT_NEAR(row["cut_px"], around, .15 * around);
    EXPECT_GT(row["recall"], .9);
    EXPECT_GT(row["edge_error_ratio"], 1);
    EXPECT_GT(row["feature_share"], 0);
    EXPECT_LT(row["feature_share"], .5);
}

TEST_F(Bench, FindsNoneInAMeshWithoutFeatures) {
    ASSERT_EQ(
        bench(
            "pictures/disc.png --methods paper --patches 120 --set stage.features=none --json figures.json"),
        0);
    const json row = rowOf(figures()["runs"], "disc");
    EXPECT_GT(row["reference_px"], 100);
    EXPECT_EQ(row["recall"], 0);
    EXPECT_EQ(row["cut_px"], 0);
    EXPECT_EQ(row["feature_share"], 0);
}

TEST_F(Bench, MagnifiesPicturesAndShapes) {
    ASSERT_EQ(bench("pictures --methods paper --patches 60 --times4 --quiet --json figures.json"), 0)
        << contentOf("err");
    EXPECT_EQ(contentOf("err"), "");
    EXPECT_THAT(contentOf("out"), HasSubstr("over bicubic dB"));
    const json all = figures();
    ASSERT_EQ(all["times4"].size(), 2u);
    EXPECT_GE(all["shapes"].size(), 3u);
    for (const char* table : {"times4", "shapes"})
        for (const json& row : all[table]) {
            EXPECT_EQ(row["within_budget"], row["coefficients"] <= row["samples"]);
            EXPECT_GT(row["psnr"], 15);
            EXPECT_GT(row["psnr_bicubic"], 15);
            EXPECT_GT(row["psnr_lanczos"], 15);
            EXPECT_NEAR(row["advantage_db"], row["psnr"].get<double>() - row["psnr_bicubic"].get<double>(),
                        1e-9);
        }
    // 18 x 16 pixels of three samples; 48 coefficients a patch.
    const json ramp = rowOf(all["times4"], "ramp");
    EXPECT_EQ(ramp["samples"], 864);
    EXPECT_EQ(ramp["coefficients"], 48 * ramp["patches"].get<int>());
    EXPECT_LE(ramp["coefficients"], 864);
    // A ramp is what both magnify best: not so a disc of 10 pixels.
    EXPECT_GT(ramp["psnr_bicubic"], rowOf(all["times4"], "disc")["psnr_bicubic"].get<double>() + 10);
}

TEST_F(Bench, TimesAPeer) {
    // Works for about a tenth of a second; its name has what a shell would trip over.
    fs::rename(mFolder / "pictures/ramp.png", mFolder / "pictures/it's a ramp.png");
    std::ofstream(at("peer.sh")) << "test -f \"$1\" || exit 1\n"
                                    "echo \"$1\" >> seen; echo chatter\n"
                                    "i=0; while [ $i -lt 30000 ]; do i=$((i+1)); done\n";
    ASSERT_EQ(bench("pictures --methods paper --patches 60,120 --peer 'sh peer.sh {in}' --json figures.json"),
              0)
        << contentOf("err");
    EXPECT_EQ(contentOf("seen"), "pictures/disc.png\npictures/it's a ramp.png\n");
    EXPECT_THAT(contentOf("out"), AllOf(HasSubstr("CPU of peer"), Not(HasSubstr("chatter"))));
    EXPECT_THAT(contentOf("err"), HasSubstr("disc peer\n"));
    const json all = figures();
    ASSERT_EQ(all["runs"].size(), 4u);
    for (const json& row : all["runs"]) {
        EXPECT_GT(row["peer_cpu_seconds"], .005);
        EXPECT_GE(row["peer_seconds"].get<double>(), .9 * row["peer_cpu_seconds"].get<double>());
        EXPECT_NEAR(row["cpu_of_peer"],
                    row["cpu_seconds"].get<double>() / row["peer_cpu_seconds"].get<double>(), 1e-9);
    }
    EXPECT_GT(rowOf(all["means"], "mean", 60)["cpu_of_peer"], 0);
    EXPECT_EQ(rowOf(all["runs"], "disc", 60)["peer_cpu_seconds"],
              rowOf(all["runs"], "disc", 120)["peer_cpu_seconds"]);
}

TEST_F(Bench, RefusesBeforeTheLongWork) {
    expectError("nowhere.png", 3, "nowhere.png");
    expectError("empty", 3, "no picture in folder 'empty'");
    expectError("pictures/disc.png pictures/notes.txt", 3, "notes.txt");
    expectError("pictures --methods magic", 2, "there is no method 'magic'");
    expectError("pictures --patches 1", 2, "2 to");
    expectError("pictures --patches some", 2, "--patches");
    expectError("pictures --set speed=9", 2, "speed");
    expectError("pictures --json nowhere/figures.json", 5, "nowhere");
    expectError("", 2, "inputs");
    expectError("pictures --peer true", 2, "{in}");
    expectError("pictures --quiet --peer 'test -d {in}'", 2,
                "disc peer: the peer failed: test -d 'pictures/");
    // What only the run finds out names the run.
    expectError("pictures --quiet --set stage.curves=none", 2, "disc default 1000: ");
}

TEST_F(Bench, StopsWithItsChild) {
    save("large.png", [](double x, double y, int) { return .5 + .5 * std::sin(x * y); });
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        execl(TESSERA_CLI, TESSERA_CLI, "bench", at("large.png").c_str(), "--quiet", "--patches",
              "60,61,62,63,64,65,66,67,68,69,70,71,72,73,74,75,76,77,78,79,80,81,82,83,84,85,86,87,88,89",
              nullptr);
        _exit(127);
    }
    // It listens to signals before it starts its first child; until then a signal just ends it.
    const std::string children =
        "/proc/" + std::to_string(child) + "/task/" + std::to_string(child) + "/children";
    const auto hasChild = [&] {
        std::string first;
        return static_cast<bool>(std::ifstream(children) >> first);
    };
    for (int i = 0; i < 3000 && !hasChild(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(hasChild());
    const auto asked = std::chrono::steady_clock::now();
    kill(child, SIGTERM);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count(), .5);
}

}  // namespace
}  // namespace tessera
