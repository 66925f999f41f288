// See vectorize.h.
#include "core/vectorize/vectorize.h"

#include <algorithm>
#include <chrono>
#include <map>

#include "core/base/parallel.h"
#include "core/vectorize/features.h"
#include "core/vectorize/fit_colors.h"
#include "core/vectorize/fit_curves.h"
#include "core/vectorize/initial_mesh.h"
#include "core/vectorize/simplify.h"

namespace tessera {

const std::vector<StageVariants>& stageTable() {
    static const std::vector<StageVariants> table{
        {"features", .03, {"canny", "none"}},
        {"initial-mesh", .07, {"grid"}},
        {"simplify", .60, {"quadric"}},
        {"curves", .22, {"traced", "straight"}},
        {"colours", .08, {"sampled", "sampled-nowarp"}},
    };
    return table;
}

namespace {

// A method is a choice of one variant for each stage.
const std::map<std::string, std::map<std::string, std::string>>& methods() {
    static const std::map<std::string, std::map<std::string, std::string>> table{
        {"paper",
         {{"features", "canny"},
          {"initial-mesh", "grid"},
          {"simplify", "quadric"},
          {"curves", "traced"},
          {"colours", "sampled"}}},
    };
    return table;
}

// The stages of one run: starts each with its variant, times it and files its report.
class StageRunner {
  public:
    StageRunner(const std::map<std::string, std::string>& variants, Progress& progress,
                VectorizeReport& report)
        : mVariants(variants), mProgress(progress), mReport(report) {}

    template <class Stage>
    auto operator()(const std::string& name, Stage&& stage) {
        double weight = 0;
        for (const StageVariants& s : stageTable())
            if (s.stage == name) weight = s.weight;
        mProgress.beginStage(name, weight);
        StageReport report{name, mVariants.at(name), 0, {}};
        const auto start = std::chrono::steady_clock::now();
        auto result = stage(report);
        report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        mReport.stages.push_back(std::move(report));
        return result;
    }

  private:
    const std::map<std::string, std::string>& mVariants;
    Progress& mProgress;
    VectorizeReport& mReport;
};

// Section 4, in order.
Result<VectorImage> runStages(const Image& image, const VectorizeSettings& settings,
                              const std::map<std::string, std::string>& variants, Progress& progress,
                              const StageObserver& observe) {
    VectorImage result;
    StageRunner run(variants, progress, result.report);
    auto features =
        run("features", [&](StageReport& r) { return detectFeatures(image, settings, r, progress); });
    if (!features) return tl::unexpected(features.error());
    if (observe.features) observe.features(*features);

    auto meshes = run("initial-mesh", [&](StageReport& r) {
        return buildInitialMesh(image, *features, settings, r, progress);
    });
    if (!meshes) return tl::unexpected(meshes.error());
    if (observe.initialMesh) observe.initialMesh(*meshes);

    auto base = run("simplify", [&](StageReport& r) {
        return simplify(std::move(*meshes), settings, r, result.report.shortfall, progress);
    });
    if (!base) return tl::unexpected(base.error());
    if (observe.baseDomain) observe.baseDomain(*base);

    auto curved = run("curves", [&](StageReport& r) {
        return fitCurves(*base, settings, r, progress, observe.initialCurves);
    });
    if (!curved) return tl::unexpected(curved.error());
    if (observe.curves) observe.curves(*curved);

    auto coloured = run("colours", [&](StageReport& r) {
        return fitColors(std::move(*curved), base->paths, image, settings, r, progress);
    });
    if (!coloured) return tl::unexpected(coloured.error());
    result.mesh = std::move(*coloured);
    return result;
}

Result<std::map<std::string, std::string>> chosenVariants(const VectorizeSettings& settings) {
    const auto method = methods().find(settings.method);
    if (method == methods().end())
        return failure(ErrorCode::Usage, "there is no method '" + settings.method + "'; use 'paper'");
    auto variants = method->second;
    for (const auto& [stage, variant] : settings.stageVariants) {
        const auto& table = stageTable();
        const auto row = std::find_if(table.begin(), table.end(),
                                      [&name = stage](const StageVariants& s) { return s.stage == name; });
        if (row == table.end()) return failure(ErrorCode::Usage, "there is no stage '" + stage + "'");
        if (std::find(row->variants.begin(), row->variants.end(), variant) == row->variants.end())
            return failure(ErrorCode::Usage, "stage '" + stage + "' has no variant '" + variant + "'");
        variants[stage] = variant;
    }
    return variants;
}

}  // namespace

std::vector<std::string> methodNames() {
    std::vector<std::string> names;
    for (const auto& [name, variants] : methods()) names.push_back(name);
    return names;
}

Result<VectorImage> vectorize(const Image& image, const VectorizeSettings& settings, Progress& progress,
                              const StageObserver& observe) {
    if (image.empty()) return failure(ErrorCode::Usage, "the picture has no pixels");
    if (settings.patches < 2) return failure(ErrorCode::Usage, "at least 2 patches are needed");
    const auto variants = chosenVariants(settings);
    if (!variants) return tl::unexpected(variants.error());
    Result<VectorImage> result;
    withThreads(settings.threads, [&] { result = runStages(image, settings, *variants, progress, observe); });
    return result;
}

}  // namespace tessera
