// Swatch files: what is written comes back, what others write is read, and what is damaged is said.
#include "app/gpl.h"

#include <gtest/gtest.h>

#include <utility>

namespace tessera {
namespace {

TEST(Gpl, ComesBackAsItWas) {
    const SwatchList list{"Été",
                          {{{0, 0, 0}, "Black"}, {{1, 1, 1}, ""}, {glm::dvec3(51, 102, 204) / 255., "a b"}}};
    const auto read = parseGpl(gplText(list), "list");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, list);
    const auto lines = parseGpl(gplText({"two\nlines", {{{0, 0, 0}, "x\n255 0 0"}}}), "list");
    ASSERT_TRUE(lines);
    EXPECT_EQ(lines->swatches.size(), 1u) << "a line break in a name is no further swatch";
}

TEST(Gpl, ReadsWhatOthersWrite) {
    const auto list = parseGpl(
        "GIMP Palette\r\nName: Tango\r\nColumns: 3\r\n# made by hand\r\n252 233  79\tButter 1\r\n"
        "  0   0   0\r\n\r\n255\t255\t255\tWhite: bright\r\n",
        "tango.gpl");
    ASSERT_TRUE(list) << list.error().message;
    EXPECT_EQ(list->name, "Tango");
    ASSERT_EQ(list->swatches.size(), 3u);
    EXPECT_EQ(list->swatches[0].name, "Butter 1");
    EXPECT_EQ(list->swatches[0].colour, glm::dvec3(252, 233, 79) / 255.);
    EXPECT_EQ(list->swatches[2].name, "White: bright");
    EXPECT_TRUE(parseGpl("GIMP Palette\n", "old.gpl")) << "the first version had no name";
}

TEST(Gpl, SaysWhatIsDamaged) {
    const std::pair<QByteArray, const char*> damaged[] = {
        {"", "GIMP Palette"},
        {"RIFF....PAL data", "GIMP Palette"},
        {"GIMP Palette\nName: x\n0 0\n", "line 3"},
        {"GIMP Palette\n#\n\n1 2 three\n", "line 4"},
        {"GIMP Palette\n0 256 0\n", "256"},
        {"GIMP Palette\n0 -1 0\n", "-1"},
        {"GIMP Palette\n0 99999999999999999999 0\n", "line 2"},
        {"GIMP Palette\n0 0 0 black\nName: late\n", "line 3"},
        {QByteArray("GIMP Palette\n").append(kMaxGplBytes, '\n'), "too large"}};
    for (const auto& [text, why] : damaged) {
        const auto list = parseGpl(text, "x.gpl");
        ASSERT_FALSE(list) << text.left(60).toStdString();
        EXPECT_EQ(list.error().code, ErrorCode::CannotRead);
        EXPECT_NE(list.error().message.find(why), std::string::npos) << list.error().message;
        EXPECT_NE(list.error().message.find("x.gpl"), std::string::npos) << list.error().message;
    }
}

}  // namespace
}  // namespace tessera
