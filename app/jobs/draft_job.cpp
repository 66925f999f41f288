// See draft_job.h.
#include "app/jobs/draft_job.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/vectorize/quality.h"
#include "core/vectorize/vectorize.h"

namespace tessera {

namespace {

using Ladder = std::shared_ptr<const DraftLadder>;

// A mesh for fewer patches has hardly a vertex beside its features, so that no rung of it would show what
// lies between them.
constexpr int kLeastPatches = 2000;
constexpr double kLeastInitialPatches = 8000;

// A vectorization that ends as soon as it has got to the ladder.
Result<Ladder> buildLadder(const Image& photo, VectorizeSettings settings, Progress& progress) {
    const Result<void> draft = applyPreset(settings, "draft");
    TESSERA_CHECK(draft.has_value());
    settings.patches = std::max(settings.patches, kLeastPatches);
    settings.initialSurplus = std::max(settings.initialSurplus, kLeastInitialPatches / settings.patches);
    const auto& stages = stageTable(settings.method);
    const double untilThen = stages[0].weight + stages[1].weight;
    std::stop_source enough;
    const std::stop_callback passOn(progress.stopToken(), [&] { enough.request_stop(); });
    Progress inner(enough.get_token(), [&](std::string_view, double, double total) {
        progress.step(std::min(1.0, total / untilThen));
    });
    Ladder ladder;
    StageObserver observe;
    observe.ladder = [&](Ladder made) {
        ladder = std::move(made);
        enough.request_stop();
    };
    progress.beginStage("draft", 1);
    const auto result = vectorize(photo, settings, inner, observe);
    if (ladder) return ladder;
    if (!result) return tl::unexpected<Error>(result.error());
    return failure(ErrorCode::Usage, "method '" + settings.method + "' has no drafts");
}

}  // namespace

Job* startLadderJob(QObject* owner, const QString& name, std::shared_ptr<const Image> photo,
                    const VectorizeSettings& settings, std::function<void(Result<Ladder>)> deliver) {
    auto* job = new Job(JobKind::Drafts, QObject::tr("Preparing drafts of %1").arg(name), owner);
    job->start<Ladder>([photo = std::move(photo),
                        settings](Progress& progress) { return buildLadder(*photo, settings, progress); },
                       std::move(deliver));
    return job;
}

Job* startRungJob(QObject* owner, Ladder ladder, size_t patches,
                  std::function<void(Result<PatchMesh>)> deliver) {
    auto* job = new Job(JobKind::Drafts, {}, owner);
    job->start<PatchMesh>(
        [ladder = std::move(ladder), patches](Progress&) -> Result<PatchMesh> { return ladder->at(patches); },
        std::move(deliver));
    return job;
}

}  // namespace tessera
