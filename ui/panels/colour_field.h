// A colour to look at and to choose: a swatch with a popup, and its hex digits.
#pragma once

#include <QWidget>
#include <glm/vec3.hpp>

namespace tessera {

class ColourPopup;
class HexField;
class SwatchButton;

// Gamma-encoded sRGB, 0..1. Disabled, it is empty: there is nothing whose colour it could be.
class ColourField : public QWidget {
    Q_OBJECT

  public:
    // `name` says to a person which colour it is.
    explicit ColourField(const QString& name, QWidget* parent = nullptr);

    glm::dvec3 colour() const { return mColour; }
    // No signal. Not while the popup is open: there the user has the word.
    void setColour(glm::dvec3 srgb);
    // Opens the popup.
    void edit();
    bool editing() const;

  signals:
    // Each choice: any number of previews, then chosen() or abandoned().
    void previewed(glm::dvec3 srgb);
    void chosen(glm::dvec3 srgb);
    void abandoned();  // colour() is the one from before

  private:
    void show(glm::dvec3 srgb);

    glm::dvec3 mColour{0};
    SwatchButton* mSwatch;
    HexField* mHex;
    ColourPopup* mPopup;
};

}  // namespace tessera
