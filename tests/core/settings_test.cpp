// Settings as text: round trips, ranges and reasons.
#include "core/vectorize/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tessera {
namespace {

using ::testing::HasSubstr;

TEST(Settings, ComeBackFromTheirText) {
    VectorizeSettings settings;
    settings.method = "sharp";
    settings.patches = 12345;
    settings.cannyLow = .1 + .2;  // no short decimal
    settings.colourWeight = 1e-7;
    settings.samplesPerSide = 7;
    settings.seamPasses = 2;
    settings.initialSurplus = 1.25;
    settings.stageVariants = {{"curves", "straight"}, {"colours", "sampled-nowarp"}};
    VectorizeSettings back;
    for (const auto& [key, value] : toKeyValues(settings)) {
        const auto set = setKeyValue(back, key, value);
        ASSERT_TRUE(set) << set.error().message;
    }
    EXPECT_EQ(back, settings);
}

TEST(Settings, ListEachNumberOfTheStruct) {
    // A setting that is added to the struct must be added to the text: two of them differ in every key but
    // the stages'.
    EXPECT_EQ(toKeyValues({}).size(), 23u);
    for (const auto& [key, value] : toKeyValues({})) EXPECT_NE(key, "threads");
}

TEST(Settings, RefuseWhatIsOutOfRangeAndSayTheRange) {
    VectorizeSettings settings;
    for (const auto& [key, value] :
         std::vector<std::pair<std::string, std::string>>{{"patches", "1"},
                                                          {"patches", "2.5"},
                                                          {"patches", ""},
                                                          {"patches", "12x"},
                                                          {"patches", "1e30"},
                                                          {"cannyLow", "-0.1"},
                                                          {"cannyLow", "nan"},
                                                          {"cannyHigh", "inf"},
                                                          {"cannyHigh", " .5"},
                                                          {"curveTolerancePx", "0"},
                                                          {"featureTolerancePx", "0"},
                                                          {"cornerDegrees", "181"},
                                                          {"samplesPerSide", "1"}}) {
        const auto set = setKeyValue(settings, key, value);
        ASSERT_FALSE(set) << key << "=" << value;
        EXPECT_EQ(set.error().code, ErrorCode::Usage);
        EXPECT_THAT(set.error().message, HasSubstr(key));
        EXPECT_THAT(set.error().message, HasSubstr(" to "));
    }
    EXPECT_EQ(settings, VectorizeSettings{});
}

TEST(Settings, RefuseWhatTheyDoNotKnowAndNameWhatTheyDo) {
    VectorizeSettings settings;
    const auto set = setKeyValue(settings, "patch", "5");
    ASSERT_FALSE(set);
    EXPECT_EQ(set.error().code, ErrorCode::Usage);
    EXPECT_THAT(set.error().message, HasSubstr("samplesPerSide"));
    EXPECT_FALSE(setKeyValue(settings, "threads", "4"));
    EXPECT_FALSE(setKeyValue(settings, "method", "two words"));
    EXPECT_FALSE(setKeyValue(settings, "method", "a\nb"));
    EXPECT_FALSE(setKeyValue(settings, "stage.", "x"));
    EXPECT_FALSE(setKeyValue(settings, "stage.a b", "x"));
}

}  // namespace
}  // namespace tessera
