// How long a slider over patch counts takes to answer. Argument: a photograph.
#include <chrono>
#include <cstdio>

#include "core/export/rasterize.h"
#include "core/image/image_compare.h"
#include "core/image/image_io.h"
#include "core/vectorize/vectorize.h"

namespace tessera {
namespace {

double millisecondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

int bench(const char* path) {
    const auto picture = readImage(path);
    if (!picture) return std::fprintf(stderr, "%s\n", picture.error().message.c_str()), 1;
    std::shared_ptr<const DraftLadder> ladder;
    StageObserver observe;
    const auto start = std::chrono::steady_clock::now();
    observe.cutMesh = [&](const CutMesh&) { std::printf("up to it %8.1f ms\n", millisecondsSince(start)); };
    observe.ladder = [&](std::shared_ptr<const DraftLadder> made) {
        ladder = std::move(made);
        std::printf("with it  %8.1f ms\n", millisecondsSince(start));
    };
    VectorizeSettings settings;
    settings.refineRounds = 0;
    settings.seamPasses = 1;
    settings.stageVariants["curves"] = "straight";
    Progress progress;
    if (!vectorize(picture->image, settings, progress, observe)) return 1;
    std::printf("%zu to %zu patches\n", ladder->mostPatches(), ladder->leastPatches());
    for (size_t wanted = ladder->mostPatches(); wanted > ladder->leastPatches() / 2; wanted /= 2) {
        const auto asked = std::chrono::steady_clock::now();
        const PatchMesh mesh = ladder->at(wanted);
        const double ms = millisecondsSince(asked);
        const auto drawn = rasterize(mesh, wholePicture(mesh, {1, 1}));
        std::printf("%8zu patches %8.1f ms, mean error %.2f of 255\n", mesh.patchCount(), ms,
                    compareImages(picture->image, *drawn)->mae);
    }
    return 0;
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    if (argc == 2) return tessera::bench(argv[1]);
    std::fprintf(stderr, "usage: draft_ladder_bench PHOTO\n");
    return 2;
}
