// Both renderers draw the same of all test photographs, vectorized as a person would have them.
#include <filesystem>

#include "tests/support/gl_photographs.h"

namespace tessera {
namespace {

class Photographs : public testing::GlTest {};

TEST_F(Photographs, AreDrawnAsByTheCpu) {
    if (IsSkipped()) return;
    std::vector<std::string> paths;
    std::error_code error;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(TESSERA_TEST_IMAGES, error))
        if (entry.is_regular_file()) paths.push_back(entry.path().string());
    std::sort(paths.begin(), paths.end());
    size_t drawn = 0;
    for (const std::string& path : paths) {
        const auto photograph = readImage(path);
        if (!photograph) continue;  // some are not pictures
        SCOPED_TRACE(path);
        const Image& image = photograph->image;
        // About the size that a screen shows of them.
        const int factor = std::max(1, std::max(image.width(), image.height()) / 1000);
        const int patches = std::max(2, image.width() / factor * (image.height() / factor) / 200);
        const auto mesh = testing::meshOfPhotograph(path, factor, patches);
        if (!mesh) continue;
        testing::expectSamePictures(*mesh);
        ++drawn;
    }
    if (drawn == 0) GTEST_SKIP() << "no test photographs in " << TESSERA_TEST_IMAGES;
}

}  // namespace
}  // namespace tessera
