// See error_search.h.
#include "core/vectorize/error_search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/vectorize/quality.h"

namespace tessera {

namespace {

constexpr int kRuns = 3;
// Of log error over log patches: what photographs have on the average, and what is believed of a secant.
constexpr double kUsualSlope = -.42, kSteepest = -.9, kFlattest = -.2;
// What a standard run leaves of a draft's error.
constexpr double kOfDraft = .82;
// So close to the goal a draft tells enough.
constexpr double kNear = 1.3;

struct Run {
    bool draft;
    double patches, error;
    // A draft counts as what a full run would come to.
    double fullError() const { return draft ? kOfDraft * error : error; }
};

std::string text(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.3g", value);
    return buffer;
}

class ErrorSearch {
  public:
    ErrorSearch(const Image& image, const VectorizeSettings& settings, const ErrorGoal& goal)
        : mImage(image),
          mSettings(settings),
          mGoal(goal),
          mMost(std::max(2.0, std::floor(double(image.planeSize()) / kLeastPixelsPerPatch))) {}

    Result<VectorImage> run(Progress& progress, const StageObserver& observe);
    int patches() const { return mPatches; }

  private:
    double firstGuess() const;
    double nextGuess() const;
    bool draftNext() const;
    bool reached() const;
    Result<VectorImage> once(bool draft, double share, Progress& progress, const StageObserver& observe);
    void file(VectorizeReport& report, size_t patches) const;

    const Image& mImage;
    const VectorizeSettings& mSettings;
    const ErrorGoal& mGoal;
    double mMost;
    int mPatches = 2;
    std::vector<Run> mRuns;
};

double ErrorSearch::firstGuess() const {
    constexpr double kUsualError = 3, kUsualPxPerPatch = 200;
    const double patches =
        double(mImage.planeSize()) / kUsualPxPerPatch * std::pow(mGoal.error / kUsualError, 1 / kUsualSlope);
    // Not too far from what is usual, since pictures differ by more than a factor of ten.
    return std::clamp(patches, double(mImage.planeSize()) / 2000, double(mImage.planeSize()) / 50);
}

double ErrorSearch::nextGuess() const {
    const Run& last = mRuns.back();
    double slope = kUsualSlope;
    if (mRuns.size() > 1) {
        const Run& before = mRuns[mRuns.size() - 2];
        // Between a draft and a full run the ratio of the two is as uncertain as the slope, unless they are
        // far apart.
        const double steps = std::log(last.patches / before.patches);
        const double rise = std::log(std::max(last.fullError(), 1e-9) / std::max(before.fullError(), 1e-9));
        if (std::abs(steps) > (last.draft == before.draft ? .05 : 1.0))
            slope = std::clamp(rise / steps, kSteepest, kFlattest);
    }
    return last.patches * std::pow(mGoal.error / std::max(last.fullError(), 1e-9), 1 / slope);
}

bool ErrorSearch::reached() const {
    return !mRuns.empty() && !mRuns.back().draft &&
           std::abs(mRuns.back().error / mGoal.error - 1) <= kErrorTolerance;
}

// Another draft where the last was too far off to tell the patches of the next run.
bool ErrorSearch::draftNext() const {
    if (mRuns.empty()) return true;
    const double ratio = mRuns.back().fullError() / mGoal.error;
    return mRuns.size() == 1 && (ratio > kNear || ratio < 1 / kNear);
}

Result<VectorImage> ErrorSearch::once(bool draft, double share, Progress& progress,
                                      const StageObserver& observe) {
    VectorizeSettings settings = mSettings;
    settings.patches = mPatches;
    if (draft)
        if (auto applied = applyPreset(settings, "draft"); !applied) return tl::unexpected(applied.error());
    progress.beginStage(draft ? "draft" : "vectorize", share);
    Progress inner(progress.stopToken(),
                   [&](std::string_view, double, double total) { progress.step(.95 * total); });
    auto result = vectorize(mImage, settings, inner, draft ? StageObserver{} : observe);
    if (!result) return result;
    const auto error = mGoal.measure(result->mesh, inner);
    if (!error) return tl::unexpected(error.error());
    mRuns.push_back({draft, double(result->mesh.patchCount()), *error});
    return result;
}

void ErrorSearch::file(VectorizeReport& report, size_t patches) const {
    StageReport search{"search", "secant", 0, {{"wanted error", mGoal.error}}};
    for (size_t i = 0; i < mRuns.size(); ++i) {
        const std::string name = (mRuns[i].draft ? "draft " : "run ") + std::to_string(i + 1);
        search.figures.emplace_back(name + " patches", mRuns[i].patches);
        search.figures.emplace_back(name + " error", mRuns[i].error);
    }
    report.stages.insert(report.stages.begin(), std::move(search));
    if (reached()) return;
    const double error = mRuns.back().error;
    const std::string got = "the error is " + text(error) + " with " + std::to_string(patches) +
                            " patches, not " + text(mGoal.error) + ": ";
    std::string why = "the search ends after " + std::to_string(kRuns) +
                      " runs; start again from --patches " +
                      std::to_string(int(std::clamp(nextGuess(), 2.0, mMost)));
    if (error > mGoal.error && mPatches >= int(mMost))
        why = "there is no more than one patch for " + text(kLeastPixelsPerPatch) + " pixels";
    else if (error < mGoal.error && mPatches <= 2)
        why = "a picture has at least 2 patches";
    else if (!report.shortfall.empty())
        why = report.shortfall;
    report.shortfall = got + why;
}

Result<VectorImage> ErrorSearch::run(Progress& progress, const StageObserver& observe) {
    Result<VectorImage> result;
    double guess = firstGuess();
    constexpr double kDraftShare = .1;
    double left = 1;
    while (int(mRuns.size()) < kRuns) {
        const int before = mPatches;
        mPatches = int(std::lround(std::clamp(guess, 2.0, mMost)));
        const bool draft = draftNext();
        // At a bound the same run again would tell nothing.
        if (!mRuns.empty() && !mRuns.back().draft && mPatches == before) break;
        const double share = draft ? kDraftShare : int(mRuns.size()) + 1 == kRuns ? left : .6 * left;
        left -= share;
        result = once(draft, share, progress, observe);
        if (!result) return result;
        if (reached()) break;
        guess = nextGuess();
    }
    file(result->report, result->mesh.patchCount());
    return result;
}

}  // namespace

Result<VectorImage> vectorizeToError(const Image& image, VectorizeSettings& settings, const ErrorGoal& goal,
                                     Progress& progress, const StageObserver& observe) {
    if (!(goal.error > 0) || !std::isfinite(goal.error))
        return failure(ErrorCode::Usage, "the error wanted is a number above 0");
    if (settings.method != "default")
        return failure(ErrorCode::Usage, "only method 'default' can search for an error");
    if (image.empty()) return failure(ErrorCode::Usage, "the picture has no pixels");
    ErrorSearch search(image, settings, goal);
    auto result = search.run(progress, observe);
    settings.patches = search.patches();
    return result;
}

}  // namespace tessera
