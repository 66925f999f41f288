// See quality.h.
#include "core/vectorize/quality.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {

namespace {

struct Preset {
    std::string_view name;
    double initialSurplus;
    int refineRounds;
    double termsPerPatch;
    int seamPasses;
    bool straight;  // no curves but those of features
};

const VectorizeSettings kUsual;
const std::array kPresets{
    Preset{"draft", kUsual.initialSurplus, 0, 30, 1, true},
    Preset{"standard", kUsual.initialSurplus, kUsual.refineRounds, kUsual.termsPerPatch, kUsual.seamPasses,
           false},
    Preset{"fine", 2, 8, 84, 4, false},
    Preset{"max", 2.5, 14, 100, 4, false},
};

const std::string kCurves = "curves", kStraight = "straight";

}  // namespace

std::vector<std::string> presetNames() {
    std::vector<std::string> names;
    for (const Preset& preset : kPresets) names.emplace_back(preset.name);
    return names;
}

Result<void> applyPreset(VectorizeSettings& settings, const std::string& name) {
    const auto preset =
        std::find_if(kPresets.begin(), kPresets.end(), [&](const Preset& p) { return p.name == name; });
    if (preset == kPresets.end())
        return failure(ErrorCode::Usage,
                       "there is no preset '" + name + "'; use draft, standard, fine or max");
    settings.initialSurplus = preset->initialSurplus;
    settings.refineRounds = preset->refineRounds;
    settings.termsPerPatch = preset->termsPerPatch;
    settings.seamPasses = preset->seamPasses;
    if (preset->straight)
        settings.stageVariants[kCurves] = kStraight;
    else
        settings.stageVariants.erase(kCurves);
    return {};
}

std::string presetOf(const VectorizeSettings& settings) {
    for (const std::string& name : presetNames()) {
        VectorizeSettings changed = settings;
        if (applyPreset(changed, name) && changed == settings) return name;
    }
    return {};
}

int patchesForDetail(double detail, int width, int height) {
    constexpr double kCoarsestPx = 3000, kFinestPx = 30;
    const double share = std::clamp(detail, 0.0, 1.0);
    const double pixelsPerPatch = kCoarsestPx * std::pow(kFinestPx / kCoarsestPx, share);
    return std::max(2, int(std::lround(double(width) * height / pixelsPerPatch)));
}

void setFeatureShare(VectorizeSettings& settings, double share) {
    settings.featureBudget = 2 * kUsual.featureBudget * share;
}

double featureShare(const VectorizeSettings& settings) {
    return std::clamp(settings.featureBudget / (2 * kUsual.featureBudget), 0.0, 1.0);
}

}  // namespace tessera
