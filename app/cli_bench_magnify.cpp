// See cli_bench_magnify.h.
#include "app/cli_bench_magnify.h"

#include <algorithm>

#include "core/export/rasterize.h"
#include "core/image/resample.h"
#include "core/vectorize/vectorize.h"

namespace tessera::cli {

namespace {

// Few patches with many terms magnify better than many with few: they have fewer seams.
constexpr int kTermsPerPatch = 105;

// The numbers that a reader needs for the colours: the side conditions give three of a channel's n + 3.
size_t storedCoefficients(const PatchMesh& mesh) {
    size_t count = 0;
    mesh.forEachPatch([&](PatchId p) {
        for (int c = 0; c < mesh.channels(); ++c)
            count += std::max<size_t>(3, mesh.spline(p).terms[size_t(c)]);
    });
    return count;
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
    settings.termsPerPatch = kTermsPerPatch;
    const int terms = settings.method == "paper" ? small.channels() * kDefaultCentreCount : kTermsPerPatch;
    settings.patches = std::max(2, int(samples / size_t(terms)));
    Progress progress;
    const auto image = vectorize(small, settings, progress);
    if (!image) return tl::unexpected(image.error());
    const PatchMesh& mesh = image->mesh;
    const size_t coefficients = storedCoefficients(mesh);
    const auto drawn = rasterize(mesh, wholePicture(mesh, {kMagnification, kMagnification}), {.samples = 4});
    if (!drawn) return tl::unexpected(drawn.error());

    Json row;
    row["wanted"] = settings.patches;
    row["patches"] = mesh.patchCount();
    row["coefficients"] = coefficients;
    row["samples"] = samples;
    row["within_budget"] = coefficients <= samples;
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
