// The popup of a colour field: lightness, chroma and hue on sliders painted with what they would give, and
// the hex digits.
#pragma once

#include <QFrame>
#include <array>
#include <glm/vec3.hpp>

class QDoubleSpinBox;

namespace tessera {

class GestureSlider;
class HexField;

// (L, C, h) with C lowered until the colour is one of sRGB; gamma-encoded.
glm::dvec3 oklchInGamut(glm::dvec3 lch);

// Opening it and closing it is one choice: the colours in between are previews, Escape takes them back.
class ColourPopup : public QFrame {
    Q_OBJECT

  public:
    explicit ColourPopup(QWidget* parent);

    void setColour(glm::dvec3 srgb);
    glm::dvec3 colour() const { return mColour; }
    // Below `field`, or above it where there is no room.
    void open(const QWidget* field);

  signals:
    void previewed(glm::dvec3 srgb);
    // It has been closed: with another colour than it was opened with, or else with that, as by Escape.
    void chosen(glm::dvec3 srgb);
    void cancelled();

  protected:
    void paintEvent(QPaintEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void hideEvent(QHideEvent* event) override;

  private:
    void addRow(int row, int coordinate, const QString& letter, const QString& name, int decimals);
    void setCoordinate(int coordinate, double value);
    void showCoordinates();

    glm::dvec3 mLch{0};  // as the sliders have it, in the gamut or not
    glm::dvec3 mColour{0};
    glm::dvec3 mBefore{0};
    bool mOpen = false;
    std::array<GestureSlider*, 3> mSliders{};
    std::array<QDoubleSpinBox*, 3> mFields{};
    HexField* mHex = nullptr;
    QWidget* mComparison = nullptr;
};

}  // namespace tessera
