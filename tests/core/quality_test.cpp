// Presets, detail and features as settings.
#include "core/vectorize/quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tessera {
namespace {

using ::testing::HasSubstr;

VectorizeSettings preset(const std::string& name) {
    VectorizeSettings settings;
    EXPECT_TRUE(applyPreset(settings, name)) << name;
    return settings;
}

TEST(Quality, StandardIsTheDefault) {
    EXPECT_EQ(preset("standard"), VectorizeSettings{});
    EXPECT_EQ(presetOf({}), "standard");
}

TEST(Quality, EachPresetWorksHarderThanTheOneBefore) {
    const auto names = presetNames();
    ASSERT_EQ(names, (std::vector<std::string>{"draft", "standard", "fine", "max"}));
    for (size_t i = 1; i < names.size(); ++i) {
        const VectorizeSettings less = preset(names[i - 1]), more = preset(names[i]);
        EXPECT_LT(less.refineRounds, more.refineRounds);
        EXPECT_LT(less.termsPerPatch, more.termsPerPatch);
    }
}

TEST(Quality, PresetsReplaceEachOtherAndLeaveTheRest) {
    for (const std::string& first : presetNames())
        for (const std::string& second : presetNames()) {
            VectorizeSettings settings;
            settings.patches = 77;
            settings.featureBudget = .125;
            settings.stageVariants["features"] = "none";
            VectorizeSettings direct = settings;
            ASSERT_TRUE(applyPreset(direct, second));
            ASSERT_TRUE(applyPreset(settings, first));
            EXPECT_EQ(presetOf(settings), first);
            ASSERT_TRUE(applyPreset(settings, second));
            EXPECT_EQ(settings, direct) << first << ' ' << second;
            EXPECT_EQ(settings.patches, 77);
            EXPECT_EQ(settings.stageVariants["features"], "none");
        }
    VectorizeSettings own;
    own.refineRounds = 5;
    EXPECT_EQ(presetOf(own), "");
}

TEST(Quality, RefusesUnknownPresets) {
    VectorizeSettings settings;
    const auto applied = applyPreset(settings, "best");
    ASSERT_FALSE(applied);
    EXPECT_EQ(applied.error().code, ErrorCode::Usage);
    EXPECT_THAT(applied.error().message, HasSubstr("draft, standard, fine or max"));
    EXPECT_EQ(settings, VectorizeSettings{});
}

TEST(Quality, DetailIsLogarithmic) {
    EXPECT_EQ(patchesForDetail(0, 300, 100), 10);
    EXPECT_EQ(patchesForDetail(.5, 300, 100), 100);
    EXPECT_EQ(patchesForDetail(1, 300, 100), 1000);
    EXPECT_EQ(patchesForDetail(0, 3, 5), 2);
    EXPECT_EQ(patchesForDetail(1, 40'000, 30'000), 40'000'000);
}

TEST(Quality, FeaturesGoFromNoneToTwiceAsMany) {
    VectorizeSettings settings;
    EXPECT_EQ(featureShare(settings), .5);
    setFeatureShare(settings, 1);
    EXPECT_EQ(settings.featureBudget, 2 * VectorizeSettings{}.featureBudget);
    EXPECT_EQ(featureShare(settings), 1);
    setFeatureShare(settings, 0);
    EXPECT_EQ(settings.featureBudget, 0);
    settings.featureBudget = 100;
    EXPECT_EQ(featureShare(settings), 1);
}

}  // namespace
}  // namespace tessera
