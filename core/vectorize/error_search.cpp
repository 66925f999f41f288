// See error_search.h.
#include "core/vectorize/error_search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/vectorize/quality.h"

namespace tessera {

namespace {

// A draft takes a fifth of a full run.
constexpr int kDrafts = 3, kFullRuns = 4;
// Of log error over log patches: what photographs have on the average, and what is believed of two drafts.
constexpr double kUsualSlope = -.42, kSteepest = -.9, kFlattest = -.08;
// So close to a draft, as a factor of patches, the error between and beside drafts is known well enough.
constexpr double kNear = 1.35;

// Of two runs: a texture that no patch resolves leaves almost the same with many more of them.
constexpr double kSteepestRuns = -3, kFlattestRuns = -.04;
// How far apart runs must be in log patches to tell the slope, and how far from one the next may be.
constexpr double kSameRun = .02, kFarthest = 1.4;

struct Run {
    double patches, error;
};

// What a standard run leaves of a draft's error.
constexpr double kUsualShare = .55;

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
    double draftError(double patches) const;
    double predictedError(double patches) const;
    double nextGuess() const;
    bool draftNext(double guess) const;
    bool reached(const Run& run) const { return std::abs(run.error / mGoal.error - 1) <= kErrorTolerance; }
    Result<VectorImage> once(bool draft, int patches, double share, Progress& progress,
                             const StageObserver& observe);
    void file(VectorizeReport& report) const;

    const Image& mImage;
    const VectorizeSettings& mSettings;
    const ErrorGoal& mGoal;
    double mMost;
    int mPatches = 2;
    std::vector<Run> mDrafts, mRuns;  // drafts by their patches
};

double ErrorSearch::firstGuess() const {
    constexpr double kUsualError = 3, kUsualPxPerPatch = 200;
    const double patches =
        double(mImage.planeSize()) / kUsualPxPerPatch * std::pow(mGoal.error / kUsualError, 1 / kUsualSlope);
    // Not too far from what is usual, since pictures differ by more than a factor of ten.
    return std::clamp(patches, double(mImage.planeSize()) / 2000, double(mImage.planeSize()) / 50);
}

// A line through the two drafts around or next to `patches`, on logarithmic scales.
double ErrorSearch::draftError(double patches) const {
    const auto above = std::ranges::find_if(mDrafts, [&](const Run& d) { return d.patches >= patches; });
    auto at = size_t(std::max<std::ptrdiff_t>(above - mDrafts.begin(), 1));
    at = std::min(at, mDrafts.size() - 1);
    const Run& b = mDrafts[at];
    double slope = kUsualSlope;
    if (at > 0 && mDrafts[at - 1].patches < b.patches) {
        const Run& a = mDrafts[at - 1];
        slope =
            std::clamp(std::log(b.error / a.error) / std::log(b.patches / a.patches), kSteepest, kFlattest);
    }
    return b.error * std::pow(patches / b.patches, slope);
}

// Of a full run: a part of a draft's, which is right for the last one; through the two that are nearest to
// the goal a line.
double ErrorSearch::predictedError(double patches) const {
    if (mRuns.empty()) return kUsualShare * draftError(patches);
    if (mRuns.size() == 1) return mRuns[0].error * draftError(patches) / draftError(mRuns[0].patches);
    const auto off = [&](const Run& run) { return std::abs(std::log(run.error / mGoal.error)); };
    std::vector<Run> nearest = mRuns;
    std::partial_sort(nearest.begin(), nearest.begin() + 2, nearest.end(),
                      [&](const Run& a, const Run& b) { return off(a) < off(b); });
    const Run &a = nearest[0], &b = nearest[1];
    const double steps = std::log(b.patches / a.patches);
    const double slope = std::abs(steps) > kSameRun
                             ? std::clamp(std::log(b.error / a.error) / steps, kSteepestRuns, kFlattestRuns)
                             : kUsualSlope;
    return a.error * std::pow(patches / a.patches, slope);
}

double ErrorSearch::nextGuess() const {
    constexpr int kBisections = 40;
    double low = std::log(2), high = std::log(mMost);
    if (!mRuns.empty()) {
        const double last = std::log(mRuns.back().patches);
        low = std::max(low, std::min(last - kFarthest, high));
        high = std::min(high, std::max(last + kFarthest, low));
    }
    for (const Run& run : mRuns) {  // between what was too few and what was too many
        double& bound = run.error > mGoal.error ? low : high;
        const double at = std::log(run.patches);
        if (at > low && at < high) bound = at;
    }
    for (int i = 0; i < kBisections; ++i) {
        const double middle = (low + high) / 2;
        (predictedError(std::exp(middle)) > mGoal.error ? low : high) = middle;
    }
    return std::exp(high);
}

// Another draft where there is none near the patches of the next run.
bool ErrorSearch::draftNext(double guess) const {
    if (mDrafts.empty()) return true;
    return mRuns.empty() && int(mDrafts.size()) < kDrafts &&
           std::ranges::none_of(
               mDrafts,
               [&](const Run& d) { return std::abs(std::log(d.patches / guess)) <= std::log(kNear); });
}

Result<VectorImage> ErrorSearch::once(bool draft, int patches, double share, Progress& progress,
                                      const StageObserver& observe) {
    VectorizeSettings settings = mSettings;
    settings.patches = patches;
    if (draft)
        if (auto applied = applyPreset(settings, "draft"); !applied) return tl::unexpected(applied.error());
    progress.beginStage(draft ? "draft" : "vectorize", share);
    Progress inner(progress.stopToken(),
                   [&](std::string_view, double, double total) { progress.step(.95 * total); });
    auto result = vectorize(mImage, settings, inner, draft ? StageObserver{} : observe);
    if (!result) return result;
    const auto error = mGoal.measure(result->mesh, inner);
    if (!error) return tl::unexpected(error.error());
    // A picture without any error is one of the least: logarithms are taken.
    const Run run{double(result->mesh.patchCount()), std::max(*error, 1e-9)};
    if (draft)
        mDrafts.insert(std::ranges::upper_bound(mDrafts, run.patches, {}, &Run::patches), run);
    else
        mRuns.push_back(run);
    return result;
}

void ErrorSearch::file(VectorizeReport& report) const {
    StageReport search{"search", "secant", 0, {{"wanted error", mGoal.error}}};
    const auto add = [&](const std::string& kind, const std::vector<Run>& runs) {
        for (size_t i = 0; i < runs.size(); ++i) {
            const std::string name = kind + " " + std::to_string(i + 1);
            search.figures.emplace_back(name + " patches", runs[i].patches);
            search.figures.emplace_back(name + " error", runs[i].error);
        }
    };
    add("draft", mDrafts);
    add("run", mRuns);
    report.stages.insert(report.stages.begin(), std::move(search));
    const Run& last = mRuns.back();
    if (reached(last)) return;
    const std::string got = "the error is " + text(last.error) + " with " +
                            std::to_string(int(last.patches)) + " patches, not " + text(mGoal.error) + ": ";
    std::string why = "the search ends after " + std::to_string(kFullRuns) +
                      " runs; start again from --patches " + std::to_string(int(std::lround(nextGuess())));
    if (last.error > mGoal.error && mPatches >= int(mMost))
        why = "there is no more than one patch for " + text(kLeastPixelsPerPatch) + " pixels";
    else if (last.error < mGoal.error && mPatches <= 2)
        why = "a picture has at least 2 patches";
    else if (!report.shortfall.empty())
        why = report.shortfall;
    report.shortfall = got + why;
}

Result<VectorImage> ErrorSearch::run(Progress& progress, const StageObserver& observe) {
    constexpr double kDraftShare = .08, kRunShare = .5;
    double left = 1;
    const auto spend = [&](double share) {
        left -= share;
        return share;
    };
    double guess = firstGuess();
    while (draftNext(guess)) {
        const int patches = int(std::lround(std::clamp(guess, 2.0, mMost)));
        const auto draft = once(true, patches, spend(kDraftShare), progress, {});
        if (!draft) return draft;
        guess = nextGuess();
    }
    Result<VectorImage> result;
    while (int(mRuns.size()) < kFullRuns) {
        const int patches = int(std::lround(guess));
        // At a bound the same run again would tell nothing.
        if (!mRuns.empty() && patches == mPatches) break;
        mPatches = patches;
        result = once(false, patches, spend(int(mRuns.size()) + 1 < kFullRuns ? kRunShare * left : left),
                      progress, observe);
        if (!result) return result;
        if (reached(mRuns.back())) break;
        guess = nextGuess();
    }
    file(result->report);
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
