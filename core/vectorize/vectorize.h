// The driver of section 4: photograph in, patches out.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/cut_mesh.h"
#include "core/vectorize/draft_ladder.h"
#include "core/vectorize/feature_network.h"
#include "core/vectorize/features.h"
#include "core/vectorize/initial_mesh.h"
#include "core/vectorize/settings.h"
#include "core/vectorize/simplify.h"

namespace tessera {

struct VectorImage {
    PatchMesh mesh;
    VectorizeReport report;
};

// A stage of a method: its name, about which part of the time it takes, and its variants, the usual one
// first.
struct StageVariants {
    std::string stage;
    double weight;
    std::vector<std::string> variants;
};
// The stages of a method in order; their names are the same for all methods. The method must exist.
const std::vector<StageVariants>& stageTable(const std::string& method);

// What VectorizeSettings::method may be.
std::vector<std::string> methodNames();

// Looks at what each stage hands to the next (the pictures of Fig. 2 are made from it); any of them may be
// empty.
struct StageObserver {
    // Method "paper".
    std::function<void(const std::vector<PixelChain>&)> features;
    std::function<void(const ChannelMeshes&)> initialMesh;
    std::function<void(const BaseDomain&)> baseDomain;
    std::function<void(const PatchMesh&)> initialCurves;  // patches may fold
    // Method "default".
    std::function<void(const FeatureNetwork&)> network;
    std::function<void(const CutMesh&)> cutMesh;
    // Made only where this is not empty: it takes longer than a draft, and 12 to 16 bytes a pixel while it
    // lives.
    std::function<void(std::shared_ptr<const DraftLadder>)> ladder;
    std::function<void(const PatchMesh&)> refined;
    // Both.
    std::function<void(const PatchMesh&)> curves;
};

// Vectorizes a picture of at least 1 x 1 pixels. The same bytes for the same image and settings, whatever the
// number of threads. Fails with Usage for settings out of range or variants that do not exist, and with
// Stopped within 50 ms of a request to stop.
Result<VectorImage> vectorize(const Image& image, const VectorizeSettings& settings, Progress& progress,
                              const StageObserver& observe = {});

}  // namespace tessera
