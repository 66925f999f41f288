// See vectorize.h.
#include "core/vectorize/vectorize.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>

#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/image/resample.h"
#include "core/mesh/colour_basis.h"
#include "core/vectorize/bend_edges.h"
#include "core/vectorize/features.h"
#include "core/vectorize/fit_colors.h"
#include "core/vectorize/fit_curves.h"
#include "core/vectorize/fit_picture.h"
#include "core/vectorize/initial_mesh.h"
#include "core/vectorize/polynomial_fit.h"
#include "core/vectorize/refine.h"
#include "core/vectorize/simplify.h"
#include "core/vectorize/solve_colors.h"
#include "core/vectorize/subpixel_features.h"
#include "core/vectorize/virtual_sharp.h"

namespace tessera {

namespace {

// A method is a list of stages, each with its variants.
const std::map<std::string, std::vector<StageVariants>>& methods() {
    static const std::map<std::string, std::vector<StageVariants>> table{
        {"default",
         {{"features", .08, {"subpixel", "none"}},
          {"initial-mesh", .02, {"delaunay"}},
          {"simplify", .17, {"true-error"}},
          {"curves", .08, {"error", "straight"}},
          {"colours", .65, {"joint"}}}},
        {"paper",
         {{"features", .03, {"canny", "none"}},
          {"initial-mesh", .07, {"grid"}},
          {"simplify", .60, {"quadric"}},
          {"curves", .22, {"traced", "straight"}},
          {"colours", .08, {"sampled", "sampled-nowarp"}}}},
    };
    return table;
}

// The stages of one run: starts each with its variant, times it and files its report.
class StageRunner {
  public:
    StageRunner(const std::string& method, const std::map<std::string, std::string>& variants,
                Progress& progress, VectorizeReport& report)
        : mStages(stageTable(method)), mVariants(variants), mProgress(progress), mReport(report) {}

    template <class Stage>
    auto operator()(const std::string& name, Stage&& stage) {
        double weight = 0;
        for (const StageVariants& s : mStages)
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
    const std::vector<StageVariants>& mStages;
    const std::map<std::string, std::string>& mVariants;
    Progress& mProgress;
    VectorizeReport& mReport;
};

// Section 4, in order.
Result<VectorImage> runPaper(const Image& image, const VectorizeSettings& settings,
                             const std::map<std::string, std::string>& variants, Progress& progress,
                             const StageObserver& observe) {
    VectorImage result;
    StageRunner run("paper", variants, progress, result.report);
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

// As many features as the mesh is to be cut along.
Result<FeatureNetwork> findNetwork(const Image& image, const VectorizeSettings& settings,
                                   const std::map<std::string, std::string>& variants, StageReport& report,
                                   Progress& progress) {
    if (variants.at("features") == "none" || settings.featureBudget == 0)
        return FeatureNetwork{image.width(), image.height(), {}, {}, {}};
    auto chains = detectSubpixelFeatures(image, settings, report, progress);
    if (!chains) return tl::unexpected(chains.error());
    auto selected = selectFeatures(std::move(*chains), settings.featureBudget * settings.patches);
    auto network = buildFeatureNetwork(std::move(selected), image.width(), image.height(), settings,
                                       progress.stopToken());
    if (progress.stopRequested()) return stopped();
    report.figures.emplace_back("segments", double(network.segments.size()));
    return network;
}

// Stage "colours", variant "joint". `sharp`, in the opponent basis, is the picture without the network's
// blur.
Result<PatchMesh> fitSplines(PatchMesh mesh, const Image& image, Image sharp, const FeatureNetwork& network,
                             const VectorizeSettings& settings, StageReport& report, Progress& progress) {
    FitPicture picture(Image{});
    if (const int perSide = squaresPerSide(mesh, settings.termsPerPatch); perSide > 1) {
        Image fine = enlargedMeans(image, perSide, progress.stopToken());
        sharp = inBasis(virtualSharp(fine, network, progress.stopToken()), ColourBasis::Opponent);
        picture = FitPicture(mesh, settings.termsPerPatch, inBasis(image, ColourBasis::Opponent),
                             inBasis(std::move(fine), ColourBasis::Opponent));
    }
    const auto sites = chooseSites(mesh, sharp, settings.termsPerPatch, {progress, .05, .25});
    sharp = Image();
    if (!progress.step(.25)) return stopped();
    if (picture.means.empty()) picture = FitPicture(inBasis(image, ColourBasis::Opponent));
    return solveColors(std::move(mesh), std::move(picture), sites, settings, report, {progress, .25, 1});
}

// The default method: features cut out of their blur, a mesh by the true error of the fit, one joint solve.
Result<VectorImage> runDefault(const Image& image, const VectorizeSettings& settings,
                               const std::map<std::string, std::string>& variants, Progress& progress,
                               const StageObserver& observe) {
    VectorImage result;
    StageRunner run("default", variants, progress, result.report);
    auto network =
        run("features", [&](StageReport& r) { return findNetwork(image, settings, variants, r, progress); });
    if (!network) return tl::unexpected(network.error());
    if (observe.network) observe.network(*network);

    Image sharp = virtualSharp(image, *network, progress.stopToken());
    auto cut = run("initial-mesh", [&](StageReport& r) {
        return buildCutMesh(sharp, *network, size_t(settings.initialSurplus * settings.patches), settings, r,
                            progress);
    });
    if (!cut) return tl::unexpected(cut.error());
    if (observe.cutMesh) observe.cutMesh(*cut);

    // Large pictures are most of the memory: each lives no longer than the stage that needs it.
    sharp = inBasis(std::move(sharp), ColourBasis::Opponent);
    auto fit = std::make_unique<const PolynomialFit>(sharp);
    if (observe.ladder) {
        auto ladder =
            DraftLadder::build(*cut, std::make_shared<const Image>(sharp), *fit, settings, progress);
        if (!ladder) return tl::unexpected(ladder.error());
        observe.ladder(std::move(*ladder));
    }
    auto refined = run("simplify", [&](StageReport& r) {
        return refine(std::move(*cut), *fit, settings, r, result.report.shortfall, progress);
    });
    if (!refined) return tl::unexpected(refined.error());
    fit.reset();
    PatchMesh mesh = toPatchMesh(*refined, image.channels());
    if (observe.refined) observe.refined(mesh);

    auto curved = run("curves", [&](StageReport& r) -> Result<PatchMesh> {
        if (variants.at("curves") == "straight") return std::move(mesh);
        return bendEdges(std::move(mesh), sharp, r, progress);
    });
    if (!curved) return tl::unexpected(curved.error());
    if (observe.curves) observe.curves(*curved);

    auto coloured = run("colours", [&](StageReport& r) -> Result<PatchMesh> {
        return fitSplines(std::move(*curved), image, std::move(sharp), *network, settings, r, progress);
    });
    if (!coloured) return tl::unexpected(coloured.error());
    result.mesh = std::move(*coloured);
    return result;
}

Result<std::map<std::string, std::string>> chosenVariants(const VectorizeSettings& settings) {
    const auto method = methods().find(settings.method);
    if (method == methods().end())
        return failure(ErrorCode::Usage,
                       "there is no method '" + settings.method + "'; use 'default' or 'paper'");
    std::map<std::string, std::string> variants;
    for (const StageVariants& row : method->second) variants[row.stage] = row.variants.front();
    for (const auto& [stage, variant] : settings.stageVariants) {
        const auto& table = method->second;
        const auto row = std::find_if(table.begin(), table.end(),
                                      [&name = stage](const StageVariants& s) { return s.stage == name; });
        if (row == table.end()) return failure(ErrorCode::Usage, "there is no stage '" + stage + "'");
        if (std::find(row->variants.begin(), row->variants.end(), variant) == row->variants.end())
            return failure(ErrorCode::Usage, "stage '" + stage + "' of method '" + settings.method +
                                                 "' has no variant '" + variant + "'");
        variants[stage] = variant;
    }
    return variants;
}

}  // namespace

const std::vector<StageVariants>& stageTable(const std::string& method) {
    return methods().at(method);
}

std::vector<std::string> methodNames() {
    std::vector<std::string> names;
    for (const auto& [name, stages] : methods()) names.push_back(name);
    return names;
}

Result<VectorImage> vectorize(const Image& image, const VectorizeSettings& settings, Progress& progress,
                              const StageObserver& observe) {
    if (image.empty()) return failure(ErrorCode::Usage, "the picture has no pixels");
    if (std::max(image.width(), image.height()) > kMaxPictureSide)
        return failure(ErrorCode::Usage, "the picture is larger than " + std::to_string(kMaxPictureSide) +
                                             " px on a side; make it smaller first");
    if (auto good = checkRanges(settings); !good) return tl::unexpected(good.error());
    const auto variants = chosenVariants(settings);
    if (!variants) return tl::unexpected(variants.error());
    Result<VectorImage> result;
    withThreads(settings.threads, [&] {
        const auto run = settings.method == "paper" ? runPaper : runDefault;
        result = run(image, settings, *variants, progress, observe);
    });
    releaseFreeMemory();  // the colours' equations are thousands of parts
    return result;
}

}  // namespace tessera
