// Settings as text: the command line's --set and a document's settings chunk.
#include "core/vectorize/settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <variant>

namespace tessera {

namespace {

constexpr std::string_view kStagePrefix = "stage.";

// A number among the settings: its key, its place and its range.
struct NumberKey {
    std::string_view key;
    std::variant<int VectorizeSettings::*, double VectorizeSettings::*> member;
    double least;
    double most;
};

using S = VectorizeSettings;
const std::array kNumbers{
    NumberKey{"patches", &S::patches, 2, 50'000'000},
    NumberKey{"featureSigmaPx", &S::featureSigmaPx, 0, 100},
    NumberKey{"cannyLow", &S::cannyLow, 0, 1},
    NumberKey{"cannyHigh", &S::cannyHigh, 0, 1},
    NumberKey{"minChainPixels", &S::minChainPixels, 2, 1'000'000},
    NumberKey{"featureTolerancePx", &S::featureTolerancePx, .01, 100},
    NumberKey{"fairingRadiusPx", &S::fairingRadiusPx, 0, 100},
    NumberKey{"colourWeight", &S::colourWeight, 0, 10'000},
    NumberKey{"curveTolerancePx", &S::curveTolerancePx, .01, 1'000},
    NumberKey{"cornerDegrees", &S::cornerDegrees, 0, 180},
    NumberKey{"weightPositive", &S::weightPositive, 0, 1'000},
    NumberKey{"weightNegative", &S::weightNegative, 0, 1'000},
    NumberKey{"weightDistance", &S::weightDistance, 0, 1'000},
    NumberKey{"samplesPerSide", &S::samplesPerSide, 2, 200},
    NumberKey{"featureBudget", &S::featureBudget, 0, 1'000'000},
    NumberKey{"initialSurplus", &S::initialSurplus, 1, 1'000},
    NumberKey{"refineRounds", &S::refineRounds, 0, 1'000},
    NumberKey{"termsPerPatch", &S::termsPerPatch, 9, 160},
    NumberKey{"seamPasses", &S::seamPasses, 1, 100},
    NumberKey{"seamMeanLevels", &S::seamMeanLevels, .01, 1'000},
    NumberKey{"seamHighLevels", &S::seamHighLevels, .01, 1'000},
    NumberKey{"seamGradientWeight", &S::seamGradientWeight, 0, 1'000'000},
};

// The shortest text that reads back as the same number, in every locale.
std::string toText(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

// A name of a method, stage or variant.
bool isName(std::string_view text) {
    return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
               c == '_' || c == '.';
    });
}

bool isWhole(const NumberKey& number) {
    return std::holds_alternative<int S::*>(number.member);
}

bool inRange(const NumberKey& number, double value) {
    return value >= number.least && value <= number.most;
}

tl::unexpected<Error> outOfRange(const NumberKey& number, const std::string& value) {
    return failure(ErrorCode::Usage, std::string(number.key) + " is " +
                                         (isWhole(number) ? "a whole number from " : "a number from ") +
                                         toText(number.least) + " to " + toText(number.most) + ", not '" +
                                         value + "'");
}

double valueOf(const VectorizeSettings& settings, const NumberKey& number) {
    return std::visit([&](auto member) { return double(settings.*member); }, number.member);
}

Result<void> setNumber(VectorizeSettings& settings, const NumberKey& number, const std::string& value) {
    double parsed = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), parsed);
    if (error != std::errc() || end != value.data() + value.size() || !inRange(number, parsed) ||
        (isWhole(number) && parsed != std::floor(parsed)))
        return outOfRange(number, value);
    if (isWhole(number))
        settings.*std::get<int S::*>(number.member) = int(parsed);
    else
        settings.*std::get<double S::*>(number.member) = parsed;
    return {};
}

}  // namespace

std::vector<std::pair<std::string, std::string>> toKeyValues(const VectorizeSettings& settings) {
    std::vector<std::pair<std::string, std::string>> pairs{{"method", settings.method}};
    for (const NumberKey& number : kNumbers) {
        pairs.emplace_back(number.key, toText(valueOf(settings, number)));
    }
    for (const auto& [stage, variant] : settings.stageVariants)
        pairs.emplace_back(std::string(kStagePrefix) + stage, variant);
    return pairs;
}

Result<void> checkRanges(const VectorizeSettings& settings) {
    for (const NumberKey& number : kNumbers)
        if (const double value = valueOf(settings, number); !inRange(number, value))
            return outOfRange(number, toText(value));
    return {};
}

Result<void> setKeyValue(VectorizeSettings& settings, const std::string& key, const std::string& value) {
    if (key == "method") {
        if (!isName(value)) return failure(ErrorCode::Usage, "method is a name, not '" + value + "'");
        settings.method = value;
        return {};
    }
    if (key.starts_with(kStagePrefix)) {
        const std::string stage = key.substr(kStagePrefix.size());
        if (!isName(stage) || !isName(value))
            return failure(ErrorCode::Usage, key + " is the name of a stage's variant, not '" + value + "'");
        settings.stageVariants[stage] = value;
        return {};
    }
    const auto number =
        std::find_if(kNumbers.begin(), kNumbers.end(), [&](const NumberKey& n) { return n.key == key; });
    if (number != kNumbers.end()) return setNumber(settings, *number, value);
    std::string known = "method, stage.NAME";
    for (const NumberKey& n : kNumbers) known += ", " + std::string(n.key);
    return failure(ErrorCode::Usage, "there is no setting '" + key + "'; there are " + known);
}

}  // namespace tessera
