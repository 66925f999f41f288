// The words on the canvas that say what the colours of overlays mean.
#include <gtest/gtest.h>

#include "app/heat_map.h"
#include "tests/ui/main_window_fixture.h"
#include "ui/overlay_painter.h"

namespace tessera {
namespace {

class CanvasLegend : public MainWindowTest {
  protected:
    void SetUp() override {
        MainWindowTest::SetUp();
        openPhoto();
        vectorize();
        // The legend lies beside the picture, where nothing else has its colours.
        canvas().zoomTo(1);
        ASSERT_TRUE(settled());
    }
    int countBesidePicture(QColor colour) {
        const QImage image = grab();
        const QRectF picture(canvas().toWidget({0, 0}), canvas().toWidget({160, 120}));
        int count = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                count += !picture.adjusted(-2, -2, 2, 2).contains(x, y) &&
                         image.pixelColor(x, y).rgb() == colour.rgb();
        return count;
    }
};

TEST_F(CanvasLegend, SaysWhatTheColoursOfFeaturesMean) {
    const auto shown = [&](FeatureTint tint) {
        for (const FeatureShade& shade : featureShades(tint))
            if (countBesidePicture(shade.colour) < 40) return false;
        return true;
    };
    EXPECT_FALSE(shown(FeatureTint::Blur));
    action(ActionId::ShowFeatures)->setChecked(true);
    EXPECT_FALSE(shown(FeatureTint::Blur)) << "plain features have one colour";
    action(ActionId::ShowBlur)->setChecked(true);
    EXPECT_TRUE(shown(FeatureTint::Blur));
    action(ActionId::ShowBlur)->setChecked(false);
    action(ActionId::ShowImportance)->setChecked(true);
    EXPECT_TRUE(shown(FeatureTint::Importance));
    action(ActionId::ShowFeatures)->setChecked(false);
    action(ActionId::ShowImportance)->setChecked(false);
    EXPECT_FALSE(shown(FeatureTint::Importance));
}

TEST_F(CanvasLegend, SaysWhatTheHeatMapMeans) {
    const QColor hottest = QColor::fromRgba(qUnpremultiply(heatColour(kHeatFullLevels)));
    // Over the dark ground a colour of the map, which is not opaque, would not be what it is over the
    // picture.
    const auto red = [&] {
        const QImage image = grab();
        int count = 0;
        for (int y = image.height() - 100; y < image.height(); ++y)
            for (int x = 0; x < 60; ++x) {
                const QColor c = image.pixelColor(x, y);
                count += c.red() > 150 && c.green() < 60 && c.blue() < 60;
            }
        return count;
    };
    ASSERT_EQ(hottest.green(), 0);
    EXPECT_EQ(red(), 0);
    action(ActionId::ShowHeatMap)->setChecked(true);
    EXPECT_TRUE(QTest::qWaitFor([&] { return red() > 40; }, kWaitMs));
    action(ActionId::ShowHeatMap)->setChecked(false);
    EXPECT_EQ(red(), 0);
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return tessera::runWindowTests(argc, argv);
}
