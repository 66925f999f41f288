// tessera-cli from outside: exit codes, messages, figures, stopping.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "core/document/codec.h"
#include "core/image/image_io.h"
#include "core/vectorize/error_search.h"
#include "tests/support/random_documents.h"

namespace tessera {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

struct Outcome {
    int exitCode = -1;
    std::string out;
    std::string err;
};

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

class Cli : public ::testing::Test {
  protected:
    void SetUp() override {
        mFolder = fs::temp_directory_path() / ("tessera-cli-test-" + std::to_string(getpid()));
        fs::create_directories(mFolder / "work");
    }
    void TearDown() override { fs::remove_all(mFolder); }

    std::string path(const std::string& name) const { return (mFolder / "work" / name).string(); }

    // Starts the program; its output goes to files.
    pid_t start(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), TESSERA_CLI);
        for (const char* name : {"out", "err"}) fs::remove(mFolder / name);  // no one reads the last run's
        const pid_t child = fork();
        if (child != 0) return child;
        dup2(open((mFolder / "out").c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDOUT_FILENO);
        dup2(open((mFolder / "err").c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
        std::vector<char*> argv;
        for (std::string& a : arguments) argv.push_back(a.data());
        argv.push_back(nullptr);
        execv(TESSERA_CLI, argv.data());
        _exit(127);
    }
    Outcome finish(pid_t child) const {
        int status = 0;
        waitpid(child, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), contents(mFolder / "out"),
                contents(mFolder / "err")};
    }
    Outcome run(const std::vector<std::string>& arguments) const { return finish(start(arguments)); }

    size_t filesInWork() const {
        return size_t(std::distance(fs::directory_iterator(mFolder / "work"), fs::directory_iterator()));
    }

    void saveSample(const std::string& name) const {
        Document d;
        d.mesh = testing::curvedMesh(60, 40, 4, 3, 21);
        d.difference = ImageDifference{1.5, {1, 2, 3}, 4, 5, 31.25, 7, 8, .875};
        ASSERT_TRUE(saveDocument(d, path(name)));
    }
    void savePicture(const std::string& name, int width, int height, float value, int levels) const {
        Image image(width, height, 3, value);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.at(x, y, 0) += float((x + y) % 2 * levels) / 255;
        ASSERT_TRUE(writeImage(image, path(name)));
    }

    fs::path mFolder;
};

// An error is one line that names the program, and nothing else.
void expectError(const Outcome& outcome, int exitCode, const std::string& part) {
    EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(part), HasSubstr("tessera-cli: ")));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
}

TEST_F(Cli, TellsItsVersionAndHelp) {
    const Outcome version = run({"--version"});
    EXPECT_EQ(version.exitCode, 0);
    EXPECT_THAT(version.out, HasSubstr("tessera-cli 0."));
    const Outcome help = run({"--help"});
    EXPECT_EQ(help.exitCode, 0);
    for (const char* command : {"vectorize", "render", "info", "validate", "compare"}) {
        EXPECT_THAT(help.out, HasSubstr(command));
        EXPECT_EQ(run({command, "--help"}).exitCode, 0) << command;
    }
    EXPECT_THAT(run({"vectorize", "--help"}).out,
                AllOf(HasSubstr("initial-mesh"), HasSubstr("samplesPerSide=10")));
}

TEST_F(Cli, RefusesWrongUsage) {
    savePicture("a.png", 20, 20, .5f, 0);
    saveSample("a.tessera");
    expectError(run({}), 2, "subcommand");
    expectError(run({"paint"}), 2, "paint");
    expectError(run({"vectorize", path("a.png")}), 2, "--output");
    expectError(run({"vectorize", path("a.png"), "-o", path("b.tessera"), "--set", "patches=1"}), 2, "2 to");
    expectError(run({"vectorize", path("a.png"), "-o", path("b.tessera"), "--set", "speed=9"}), 2, "speed");
    expectError(run({"vectorize", path("a.png"), "-o", path("b.tessera"), "--set", "patches"}), 2,
                "NAME=VALUE");
    expectError(
        run({"vectorize", path("a.png"), "-o", path("b.tessera"), "--quiet", "--stage", "curves=none"}), 2,
        "none");
    expectError(run({"vectorize", path("a.png"), "-o", path("b.tessera"), "--quiet", "--method", "magic"}), 2,
                "magic");
    const auto refuses = [&](const std::vector<std::string>& options, const std::string& part) {
        for (const char* command : {"vectorize", "stages"}) {
            std::vector<std::string> arguments{command, path("a.png"), "-o", path("b"), "--quiet"};
            arguments.insert(arguments.end(), options.begin(), options.end());
            expectError(run(arguments), 2, part);
        }
    };
    refuses({"--patches", "9", "--detail", ".5"}, "one of --patches, --detail and --max-error");
    refuses({"--max-error", "2", "--detail", ".5"}, "one of --patches, --detail and --max-error");
    refuses({"--detail", "1.5"}, "--detail is a number from 0 to 1");
    refuses({"--detail", ".5", "--set", "patches=9"}, "--set patches");
    refuses({"--features", "-1"}, "--features is a number from 0 to 1");
    refuses({"--features", "nan"}, "--features is a number from 0 to 1");
    refuses({"--max-error", "0"}, "above 0");
    refuses({"--max-error", "300"}, "255");
    refuses({"--preset", "best"}, "draft, standard, fine or max");
    refuses({"--preset", "max", "--preview"}, "--preview is --preset draft");
    for (const char* option : {"--preset=fine", "--preview", "--features=1", "--max-error=3"})
        refuses({"--method", "paper", option}, "is for --method default");
    expectError(run({"render", path("a.tessera"), "-o", path("b.gif")}), 2, "gif");
    expectError(run({"render", path("a.tessera"), "-o", path("b.png"), "--samples", "3"}), 2, "samples");
    for (const char* sharpen : {"4.1", "-1", "nan", "soft"})
        expectError(run({"render", path("a.tessera"), "-o", path("b.png"), "--sharpen", sharpen}), 2,
                    "sharpen");
    expectError(run({"render", path("a.tessera"), "-o", path("b.png"), "--width", "9", "--height", "9"}), 2,
                "width");
    expectError(run({"render", path("a.tessera"), "-o", path("b.png"), "--scale", "nan"}), 2, "scale");
    expectError(run({"render", path("a.tessera"), "-o", path("b.png"), "--width", "900000"}), 2,
                "400 million");
    expectError(run({"render", path("a.tessera"), "-o", path("b.png"), "--backend", "vulkan"}), 2, "backend");
    expectError(run({"render", path("a.tessera"), "-o", path("b.png"), "--backend", "gl", "--samples", "16"}),
                2, "1 or 4 samples");
    EXPECT_EQ(filesInWork(), 2u);
}

TEST_F(Cli, RefusesWhatItCannotReadOrWrite) {
    savePicture("a.png", 20, 20, .5f, 0);
    saveSample("a.tessera");
    std::ofstream(path("text.png")) << "no picture at all";
    expectError(run({"vectorize", path("none.png"), "-o", path("b.tessera"), "--quiet"}), 3, "none.png");
    expectError(run({"vectorize", path("text.png"), "-o", path("b.tessera"), "--quiet"}), 3, "text.png");
    expectError(run({"compare", path("a.png"), path("none.png")}), 3, "none.png");
    expectError(run({"info", path("none.tessera")}), 3, "none.tessera");
    expectError(run({"info", path(".")}), 3, "read");
    expectError(run({"vectorize", path("a.png"), "-o", path("no/b.tessera"), "--quiet"}), 5, "no folder");
    expectError(run({"render", path("a.tessera"), "-o", path("no/b.png")}), 5, "no folder");
    // Found out before the picture is read.
    expectError(run({"vectorize", path("none.png"), "-o", path("."), "--quiet"}), 5, "folder");
}

TEST_F(Cli, RefusesDamagedDocuments) {
    saveSample("a.tessera");
    std::string bytes = contents(path("a.tessera"));
    std::ofstream(path("cut.tessera"), std::ios::binary) << bytes.substr(0, bytes.size() - 9);
    bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 1);
    std::ofstream(path("bad.tessera"), std::ios::binary) << bytes;
    savePicture("a.png", 20, 20, .5f, 0);
    for (const char* name : {"cut.tessera", "bad.tessera", "a.png"}) {
        expectError(run({"info", path(name)}), 4, name);
        expectError(run({"validate", path(name)}), 4, name);
        expectError(run({"render", path(name), "-o", path("b.png"), "--quiet"}), 4, name);
    }
    EXPECT_FALSE(fs::exists(path("b.png")));
}

TEST_F(Cli, ComparesPictures) {
    savePicture("a.png", 16, 16, .4f, 0);
    savePicture("b.png", 16, 16, .4f, 6);
    const Outcome outcome = run({"compare", path("a.png"), path("b.png"), "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const json j = json::parse(outcome.out);
    // Red is 6 levels off at every other pixel.
    EXPECT_NEAR(j["mae"], 1, 1e-9);
    EXPECT_NEAR(j["mae_r"], 3, 1e-9);
    EXPECT_NEAR(j["mae_g"], 0, 1e-9);
    EXPECT_NEAR(j["euclid"], 3, 1e-9);
    EXPECT_NEAR(j["rmse"], std::sqrt(6.0), 1e-9);
    EXPECT_NEAR(j["psnr"], 20 * std::log10(255 / std::sqrt(6.0)), 1e-9);
    EXPECT_NEAR(j["mae_luma"], 3 * .299, 1e-9);
    EXPECT_LT(j["ssim"], 1);
    const json same = json::parse(run({"compare", path("a.png"), path("a.png"), "--json"}).out);
    EXPECT_EQ(same["mae"], 0);
    EXPECT_TRUE(same["psnr"].is_null());
    savePicture("c.png", 15, 16, .4f, 0);
    EXPECT_EQ(run({"compare", path("a.png"), path("c.png")}).exitCode, 2);
}

TEST_F(Cli, RendersAtTheSizeThatIsAsked) {
    saveSample("a.tessera");
    const auto sizeOf = [&](const std::vector<std::string>& options, const std::string& name) {
        std::vector<std::string> arguments{"render", path("a.tessera"), "-o", path(name)};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        const auto image = readImage(path(name));
        return image ? std::pair(image->image.width(), image->image.height()) : std::pair(0, 0);
    };
    EXPECT_EQ(sizeOf({}, "a.png"), std::pair(60, 40));
    EXPECT_EQ(sizeOf({"--scale", "2.5"}, "a.jpg"), std::pair(150, 100));
    EXPECT_EQ(sizeOf({"--width", "31"}, "a.tif"), std::pair(31, 21));
    EXPECT_EQ(sizeOf({"--height", "80", "--samples", "4"}, "a.exr"), std::pair(120, 80));
    EXPECT_EQ(sizeOf({"--reference"}, "r.png"), std::pair(60, 40));
    EXPECT_EQ(sizeOf({"--samples", "1"}, "one.png"), std::pair(60, 40));
    const json j = json::parse(run({"compare", path("one.png"), path("r.png"), "--json"}).out);
    EXPECT_LT(j["mae"], .5);  // two renderers, one picture
}

TEST_F(Cli, RendersWithOpenGlOrSaysThatThereIsNone) {
    saveSample("a.tessera");
    const std::vector<std::string> arguments{"render", path("a.tessera"), "-o", path("gl.png"), "--scale",
                                             "20",     "--backend",       "gl"};  // of more than one tile
    const Outcome outcome = run(arguments);
    if (outcome.exitCode == 0) {
        ASSERT_EQ(run({"render", path("a.tessera"), "-o", path("cpu.png"), "--scale", "20"}).exitCode, 0);
        const json j = json::parse(run({"compare", path("gl.png"), path("cpu.png"), "--json"}).out);
        EXPECT_LT(j["mae"], .1);
    }
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
    const Outcome without = run(arguments);
    unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
    EXPECT_NE(without.exitCode, 0);
    EXPECT_THAT(without.err, HasSubstr("OpenGL 4.5 is not available"));
}

TEST_F(Cli, ShowsWhatIsInADocument) {
    saveSample("a.tessera");
    const json j = json::parse(run({"info", path("a.tessera"), "--json"}).out);
    EXPECT_EQ(j["patches"], 24);
    EXPECT_EQ(j["vertices"], 20);
    EXPECT_EQ(j["curves"], 43);
    EXPECT_EQ(j["coefficients"], 24 * 57);
    EXPECT_EQ(j["errors"]["psnr"], 31.25);
    EXPECT_EQ(j["bytes"], fs::file_size(path("a.tessera")));
    EXPECT_EQ(j["settings"]["method"], "default");
    EXPECT_TRUE(j["chunks"].contains("COLR"));
    EXPECT_THAT(run({"info", path("a.tessera")}).out, HasSubstr("patches"));
}

TEST_F(Cli, ValidatesADocument) {
    saveSample("a.tessera");
    const Outcome good = run({"validate", path("a.tessera"), "--json"});
    EXPECT_EQ(good.exitCode, 0) << good.out;
    const json j = json::parse(good.out);
    EXPECT_EQ(j["violation_count"], 0);
    EXPECT_GT(j["min_bernstein"], -1);
    EXPECT_EQ(j["uncovered_pixels"], 0);

    Document folded;
    folded.mesh = testing::gridMesh(40, 40, 2, 2);
    folded.mesh.setInterior(PatchId(3), {100'000, 0});
    ASSERT_TRUE(saveDocument(folded, path("folded.tessera")));
    const Outcome bad = run({"validate", path("folded.tessera")});
    EXPECT_EQ(bad.exitCode, 4);
    EXPECT_THAT(bad.err, HasSubstr("violation"));
    EXPECT_THAT(bad.out, HasSubstr("3"));
}

TEST_F(Cli, VectorizesAPicture) {
    savePicture("a.png", 48, 40, .3f, 40);
    const Outcome outcome = run(
        {"vectorize", path("a.png"), "-o", path("a.tessera"), "--patches", "60", "--json", "--threads", "1"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("simplify\n"), Not(HasSubstr("\r"))));
    const json j = json::parse(outcome.out);
    for (const char* key : {"patches", "vertices", "curves", "features", "seconds", "stages", "peak_rss_mb",
                            "bytes", "errors", "shortfall"})
        EXPECT_TRUE(j.contains(key)) << key;
    EXPECT_EQ(j["bytes"], fs::file_size(path("a.tessera")));
    EXPECT_EQ(filesInWork(), 2u);

    // What it stored is what info and a rendering say.
    const json info = json::parse(run({"info", path("a.tessera"), "--json"}).out);
    EXPECT_EQ(info["errors"], j["errors"]);
    EXPECT_EQ(info["source_embedded"], true);
    ASSERT_EQ(run({"render", path("a.tessera"), "-o", path("r.png"), "--quiet", "--samples", "4"}).exitCode,
              0);
    const json measured = json::parse(run({"compare", path("a.png"), path("r.png"), "--json"}).out);
    EXPECT_NEAR(measured["mae"], j["errors"]["mae"], 1e-9);

    const Outcome quiet = run({"vectorize", path("a.png"), "-o", path("b.tessera"), "--patches", "60",
                               "--quiet", "--no-embed", "--threads", "2"});
    EXPECT_EQ(quiet.exitCode, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
    EXPECT_EQ(json::parse(run({"info", path("b.tessera"), "--json"}).out)["source_embedded"], false);
}

TEST_F(Cli, TakesDetailPresetsAndFeatures) {
    savePicture("a.png", 60, 50, .3f, 40);
    const auto info = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"vectorize", path("a.png"), "-o", path("a.tessera"), "--quiet"});
        const Outcome outcome = run(options);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return json::parse(run({"info", path("a.tessera"), "--json"}).out)["settings"];
    };
    const json detailed = info({"--detail", "1"});
    EXPECT_EQ(detailed["patches"], "100");
    EXPECT_EQ(detailed["method"], "default");
    EXPECT_EQ(detailed["refineRounds"], "4");
    for (const json& draft :
         {info({"--preview", "--patches", "30"}), info({"--preset", "draft", "--patches", "30"})}) {
        EXPECT_EQ(draft["patches"], "30");
        EXPECT_EQ(draft["refineRounds"], "0");
        EXPECT_EQ(draft["stage.curves"], "straight");
    }
    EXPECT_EQ(info({"--preset", "max", "--set", "termsPerPatch=50"})["termsPerPatch"], "50");
    EXPECT_EQ(info({"--features", "0"})["featureBudget"], "0");
    EXPECT_EQ(info({"--method", "paper", "--detail", ".9"})["method"], "paper");
}

TEST_F(Cli, FindsThePatchesForAnError) {
    // So large that a patch more or less is a small part of the error.
    Image image(192, 144, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 144; ++y)
            for (int x = 0; x < 192; ++x)
                image.at(x, y, c) =
                    .5F + .3F * std::sin(.3F * float(x) + float(c)) * std::cos(.001F * float(y * y));
    ASSERT_TRUE(writeImage(image, path("a.png")));
    const Outcome outcome =
        run({"vectorize", path("a.png"), "-o", path("a.tessera"), "--max-error", "2", "--json", "--quiet"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const json j = json::parse(outcome.out);
    EXPECT_EQ(j["stages"][0]["stage"], "search");
    EXPECT_EQ(j["stages"][0]["figures"]["wanted error"], 2);
    const double mae = j["errors"]["mae"];
    EXPECT_EQ(j["shortfall"] == "", std::abs(mae - 2) <= 2 * kErrorTolerance) << j["shortfall"];
    EXPECT_NEAR(mae, 2, .1);
}

TEST_F(Cli, DrawsTheStagesOfBothMethods) {
    savePicture("a.png", 40, 32, .3f, 40);
    const auto drawn = [&](const std::string& method) {
        const Outcome outcome = run(
            {"stages", path("a.png"), "-o", path(method), "--method", method, "--patches", "40", "--quiet"});
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(path(method)))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    };
    EXPECT_EQ(drawn("default"), (std::vector<std::string>{"1_features.png", "2_initial_mesh.png",
                                                          "3_refined_mesh.png", "4_curved_patches.png",
                                                          "5_reconstruction.png", "6_residual_x4.png"}));
    EXPECT_EQ(drawn("paper"), (std::vector<std::string>{"1_features.png", "2_initial_mesh.png",
                                                        "3_simplified_mesh.png", "4_base_domain.png",
                                                        "5_initial_patches.png", "6_optimized_patches.png",
                                                        "7_reconstruction.png", "8_residual_x4.png"}));
}

// The first photograph of the test images, or none.
std::string somePhotograph() {
    std::vector<std::string> found;
    std::error_code error;
    for (const auto& entry : fs::recursive_directory_iterator(TESSERA_TEST_IMAGES, error))
        if (entry.path().extension() == ".png" && entry.path().filename().string().starts_with("kodim"))
            found.push_back(entry.path().string());
    std::sort(found.begin(), found.end());
    return found.empty() ? "" : found.front();
}

TEST_F(Cli, StopsAtOnceAndLeavesNothing) {
    const std::string photograph = somePhotograph();
    if (photograph.empty()) GTEST_SKIP() << "no test photographs in " << TESSERA_TEST_IMAGES;
    for (const int signal : {SIGINT, SIGTERM})
        for (const char* stage : {"features", "initial-mesh", "simplify"}) {
            const pid_t child = start({"vectorize", photograph, "-o", path("a.tessera")});
            for (int i = 0; i < 3000 && contents(mFolder / "err").find(stage) == std::string::npos; ++i)
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            const auto asked = std::chrono::steady_clock::now();
            kill(child, signal);
            const Outcome outcome = finish(child);
            const double seconds =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
            EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
            EXPECT_THAT(outcome.err, HasSubstr("stopped"));
            EXPECT_LT(seconds, .5) << stage;  // 0.2 s on an idle machine
            EXPECT_EQ(filesInWork(), 0u);
        }
}

}  // namespace
}  // namespace tessera
