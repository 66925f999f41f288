// What a vectorization is asked to do, and what it reports of what it did.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace tessera {

// A method is a choice of one variant for each stage; a setting changes a number of a stage. Defaults are the
// paper's where it states them.
struct VectorizeSettings {
    std::string method = "default";
    int patches = 2000;  // wanted; at least 2
    int threads = 0;     // 0: one for each core. Never changes the result.
    // Variants that replace the method's own, by stage name: see vectorize.h.
    std::map<std::string, std::string> stageVariants;

    // Features (4.1). Thresholds are fractions of the largest gradient of the picture.
    double featureSigmaPx = 1;
    double cannyLow = .05;
    double cannyHigh = .125;
    int minChainPixels = 10;
    double featureTolerancePx = .5;  // of the cubics of subpixel features to their points

    // Initial mesh (4.1): Taubin fairing of colours within this distance of features; 0 is off.
    double fairingRadiusPx = 0;

    // Simplification (4.2).
    double colourWeight = 5.0;    // px per unit of colour (0..1) when colour is a height
    double curveTolerancePx = 1;  // of a feature's cubic to its polyline
    double cornerDegrees = 40;    // a turn at a join sharper than this stays a corner

    // Boundary curves (4.3), Eq. 1.
    double weightPositive = .2;  // w_p
    double weightNegative = 1;   // w_n
    double weightDistance = 5;   // w_d

    // Colours (4.4).
    int samplesPerSide = 10;  // n

    // The default method.
    double featureBudget = .34;  // feature edges for each patch wanted, at most
    double initialSurplus = 2;   // faces of the initial mesh for each patch wanted
    int refineRounds = 4;        // of the true-error stage
    double termsPerPatch = 64;   // of the colour splines, over all channels, on the average
    int seamPasses = 3;          // solutions from which the weight of seams is found; the first takes 1
    // Along edges that are no features the colours of both sides differ by so many levels (of 255) on the
    // mean, and by so many at the 95th percentile, at most.
    double seamMeanLevels = 2.6;
    double seamHighLevels = 8.7;
    double seamGradientWeight = .005;  // of a squared difference a pixel off, against that on the edge

    bool operator==(const VectorizeSettings&) const = default;
};

// One `key=value` for each setting but `threads` (which changes nothing), in a fixed order: what a document
// keeps.
std::vector<std::pair<std::string, std::string>> toKeyValues(const VectorizeSettings& settings);
// Sets one of them; Usage for an unknown key or a value out of range, with the reason.
Result<void> setKeyValue(VectorizeSettings& settings, const std::string& key, const std::string& value);

// Usage where a number is outside its range, with the range.
Result<void> checkRanges(const VectorizeSettings& settings);

struct StageReport {
    std::string stage;
    std::string variant;
    double seconds = 0;
    // Named figures in the order in which the stage found them ("chains", "collapses", ...).
    std::vector<std::pair<std::string, double>> figures;

    bool operator==(const StageReport&) const = default;
};

struct VectorizeReport {
    std::vector<StageReport> stages;
    // Why the wanted number of patches was not reached; empty where it was.
    std::string shortfall;

    bool operator==(const VectorizeReport&) const = default;
};

}  // namespace tessera
