// What a person chooses in the place of settings: how good, how detailed, how many features.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/vectorize/settings.h"

namespace tessera {

// From the quickest to the best: "draft", "standard", "fine", "max".
std::vector<std::string> presetNames();
// Sets what distinguishes the presets (rounds, terms, passes, the variant of the curves) and nothing else.
// Usage for an unknown name.
Result<void> applyPreset(VectorizeSettings& settings, const std::string& name);
// The preset that would change nothing; empty where none is.
std::string presetOf(const VectorizeSettings& settings);

// How many patches suit a picture of this size at a detail of 0 (3000 px a patch) to 1 (30 px a patch), on a
// logarithmic scale; at least 2.
int patchesForDetail(double detail, int width, int height);

// The part of the features that is cut out of their blur, as one number from 0 (none) over .5 (as many as
// the default) to 1 (twice as many).
void setFeatureShare(VectorizeSettings& settings, double share);
double featureShare(const VectorizeSettings& settings);  // clamped to 0..1

}  // namespace tessera
