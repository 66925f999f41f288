// See cli_bench_measure.h.
#include "app/cli_bench_measure.h"

#include <algorithm>
#include <ctime>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/cli_bench_features.h"
#include "app/cli_document_facts.h"
#include "core/document/codec.h"
#include "core/export/rasterize.h"
#include "core/image/jpeg_reference.h"
#include "core/mesh/mesh_validate.h"
#include "core/vectorize/vectorize.h"

namespace tessera::cli {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

double cpuSeconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

double smallestAngleDegrees(const BezierTriangle& patch) {
    double smallest = 180;
    for (int s = 0; s < 3; ++s) {
        const glm::dvec2 a = patch.corner((s + 1) % 3) - patch.corner(s);
        const glm::dvec2 b = patch.corner((s + 2) % 3) - patch.corner(s);
        smallest = std::min(smallest, std::abs(std::atan2(cross(a, b), glm::dot(a, b))) * kDegrees);
    }
    return smallest;
}

void addShape(Json& row, const PatchMesh& mesh) {
    std::vector<double> angles;
    mesh.forEachPatch(
        [&](PatchId p) { angles.push_back(smallestAngleDegrees(toPixels(mesh.controlPoints(p)))); });
    const auto slivers = std::ranges::count_if(angles, [](double angle) { return angle < kSliverDegrees; });
    const auto middle = angles.begin() + std::ptrdiff_t(angles.size() / 2);
    std::ranges::nth_element(angles, middle);
    row["sliver_share"] = double(slivers) / double(angles.size());
    row["median_angle"] = *middle;
}

Result<ImageDifference> differenceOf(const PatchMesh& mesh, const Image& picture,
                                     Image* rendering = nullptr) {
    auto drawn = rasterize(mesh, wholePicture(mesh, {1, 1}), {.samples = 4});
    if (!drawn) return tl::unexpected(drawn.error());
    auto difference = compareImages(picture, *drawn);
    if (rendering != nullptr) *rendering = std::move(*drawn);
    return difference;
}

// "bytes", and of what a reader of the file gets: the seams, the error, whose drop is the codec's loss, and
// what a JPEG with that error takes.
Result<void> addCodec(Json& row, const VectorImage& vectorized, const VectorizeSettings& settings,
                      const Image& picture, const ImageDifference& errors) {
    Document document;
    document.mesh = vectorized.mesh;
    document.settings = settings;
    document.report = vectorized.report;
    document.difference = errors;
    const auto bytes = encodeDocument(document);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto decoded = decodeDocument(*bytes);
    if (!decoded) return tl::unexpected(decoded.error());
    const auto difference = differenceOf(decoded->mesh, picture);
    if (!difference) return tl::unexpected(difference.error());
    row["bytes"] = bytes->size();
    const SeamStatistics seams = measureSeams(decoded->mesh);
    row["seam_mean"] = seams.mean;
    row["seam_p95"] = seams.p95;
    row["psnr_decoded"] = difference->psnr;
    row["codec_loss_db"] = errors.psnr - difference->psnr;
    const auto jpeg = referenceJpegBytes(picture, difference->psnr);
    if (!jpeg) return tl::unexpected(jpeg.error());
    row["jpeg_bytes"] = *jpeg ? Json(**jpeg) : Json();
    row["bytes_of_jpeg"] = *jpeg ? Json(double(bytes->size()) / **jpeg) : Json();
    return {};
}

}  // namespace

Result<Image> readPicture(const std::string& path) {
    const auto file = readFile(path);
    if (!file) return tl::unexpected(file.error());
    auto loaded = readImage(*file, path);
    if (!loaded) return tl::unexpected(loaded.error());
    return std::move(loaded->image);
}

Result<Json> measureRun(const std::string& path, const VectorizeSettings& settings) {
    const auto picture = readPicture(path);
    if (!picture) return tl::unexpected(picture.error());
    Progress progress;
    const auto start = std::chrono::steady_clock::now();
    const double cpuBefore = cpuSeconds();
    const auto vectorized = vectorize(*picture, settings, progress);
    if (!vectorized) return tl::unexpected(vectorized.error());
    Json cost;
    for (const StageReport& stage : vectorized->report.stages) cost["seconds_" + stage.stage] = stage.seconds;
    cost["seconds"] = secondsSince(start);
    cost["cpu_seconds"] = cpuSeconds() - cpuBefore;
    cost["peak_rss_mb"] = peakRssMb();

    const PatchMesh& mesh = vectorized->mesh;
    Json row = countsOf(mesh);
    row["shortfall"] = vectorized->report.shortfall;
    Image rendering;
    const auto difference = differenceOf(mesh, *picture, &rendering);
    if (!difference) return tl::unexpected(difference.error());
    row.update(toJson(*difference));
    addShape(row, mesh);
    row["folds"] = validate(mesh).violationCount;
    row.update(measureFeatures(*picture, rendering, mesh));
    if (const auto added = addCodec(row, *vectorized, settings, *picture, *difference); !added)
        return tl::unexpected(added.error());
    row.update(cost);
    row["stages"] = toJson(vectorized->report);
    return row;
}

}  // namespace tessera::cli
