// Both renderers draw the same of vectorized photographs, made small: those of normal size are in
// photographs_slow_test.
#include "tests/support/gl_photographs.h"

namespace tessera {
namespace {

struct Photograph {
    const char* path;
    int factor;
};
void PrintTo(const Photograph& p, std::ostream* out) {
    *out << p.path;
}

class SmallPhotograph : public testing::GlTest, public ::testing::WithParamInterface<Photograph> {};

TEST_P(SmallPhotograph, IsDrawnAsByTheCpu) {
    if (IsSkipped()) return;
    const auto mesh = testing::meshOfPhotograph(std::string(TESSERA_TEST_IMAGES "/") + GetParam().path,
                                                GetParam().factor, 300);
    if (!mesh) GTEST_SKIP() << "no test photographs in " << TESSERA_TEST_IMAGES;
    testing::expectSamePictures(*mesh);
}

INSTANTIATE_TEST_SUITE_P(, SmallPhotograph,
                         ::testing::Values(Photograph{"kodak/kodim23.png", 3},
                                           Photograph{"kodak/kodim05.png", 3},
                                           Photograph{"hard/rgba_soft.png", 1}));

}  // namespace
}  // namespace tessera
