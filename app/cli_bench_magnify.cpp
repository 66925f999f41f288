// See cli_bench_magnify.h.
#include "app/cli_bench_magnify.h"

#include <algorithm>
#include <optional>

#include "core/export/rasterize.h"
#include "core/image/resample.h"
#include "core/vectorize/vectorize.h"

namespace tessera::cli {

namespace {

constexpr int kTries = 4;
// A run that stores this share of what it may is not tried again with more patches.
constexpr double kWellUsed = .97;

// The numbers that a reader needs for the colours: the side conditions give three of a channel's n + 3.
size_t storedCoefficients(const PatchMesh& mesh) {
    size_t count = 0;
    mesh.forEachPatch([&](PatchId p) {
        for (int c = 0; c < mesh.channels(); ++c)
            count += std::max<size_t>(3, mesh.spline(p).terms[size_t(c)]);
    });
    return count;
}

struct Run {
    VectorImage image;
    int wanted = 0;
    size_t coefficients = 0;
};

// The run with the most coefficients within the budget, or with the fewest where none is within.
Result<Run> vectorizeWithin(const Image& small, VectorizeSettings settings, size_t budget) {
    std::optional<Run> best;
    settings.patches = std::max(2, int(budget / size_t(small.channels() * kDefaultCentreCount)));
    for (int i = 0; i < kTries; ++i) {
        Progress progress;
        auto image = vectorize(small, settings, progress);
        if (!image) return tl::unexpected(image.error());
        const size_t count = storedCoefficients(image->mesh);
        const int next = std::max(2, int(double(image->mesh.patchCount()) * double(budget) / double(count)));
        const bool within = count <= budget;
        const bool better = !best || (within ? best->coefficients > budget || count > best->coefficients
                                             : count < best->coefficients);
        if (better) best = Run{std::move(*image), settings.patches, count};
        if (next == settings.patches || (within && double(count) >= kWellUsed * double(budget))) break;
        settings.patches = next;
    }
    return std::move(*best);
}

// "psnr" and "ssim" with `suffix`.
Result<void> addComparison(Json& row, const std::string& suffix, const Image& picture,
                           const Image& magnified) {
    const auto difference = compareImages(picture, magnified);
    if (!difference) return tl::unexpected(difference.error());
    const Json figures = toJson(*difference);
    for (const char* name : {"psnr", "ssim"}) row[name + suffix] = figures[name];
    return {};
}

}  // namespace

Result<Json> measureMagnified(const Image& picture, VectorizeSettings settings) {
    if (std::min(picture.width(), picture.height()) < kMagnification)
        return failure(ErrorCode::Usage,
                       "a picture of less than 4 pixels a side cannot be shrunk by 4; leave "
                       "--times4 out");
    const Image small = boxDownsample(picture, kMagnification);
    const Image original = cropped(picture, small.width() * kMagnification, small.height() * kMagnification);
    const size_t samples = small.planeSize() * size_t(small.channels());
    const auto run = vectorizeWithin(small, std::move(settings), samples);
    if (!run) return tl::unexpected(run.error());
    const auto drawn = rasterize(
        run->image.mesh, wholePicture(run->image.mesh, {kMagnification, kMagnification}), {.samples = 4});
    if (!drawn) return tl::unexpected(drawn.error());

    Json row;
    row["wanted"] = run->wanted;
    row["patches"] = run->image.mesh.patchCount();
    row["coefficients"] = run->coefficients;
    row["samples"] = samples;
    row["within_budget"] = run->coefficients <= samples;
    const auto added = addComparison(row, "", original, *drawn)
                           .and_then([&] {
                               return addComparison(row, "_bicubic", original,
                                                    upsample(small, kMagnification, ResampleFilter::Bicubic));
                           })
                           .and_then([&] {
                               return addComparison(row, "_lanczos", original,
                                                    upsample(small, kMagnification, ResampleFilter::Lanczos));
                           });
    if (!added) return tl::unexpected(added.error());
    row["advantage_db"] = row["psnr"].is_number() && row["psnr_bicubic"].is_number()
                              ? Json(row["psnr"].get<double>() - row["psnr_bicubic"].get<double>())
                              : Json(nullptr);
    return row;
}

}  // namespace tessera::cli
