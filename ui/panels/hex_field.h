// A field for a colour's hex digits.
#pragma once

#include <QLineEdit>
#include <glm/vec3.hpp>

namespace tessera {

// "#rrggbb", gamma-encoded sRGB; "rgb" and "rrggbb" with or without # can be typed. Disabled, it is empty.
class HexField : public QLineEdit {
    Q_OBJECT

  public:
    explicit HexField(QWidget* parent = nullptr);

    // No signal.
    void setColour(glm::dvec3 srgb);

  signals:
    // Another colour has been typed. What is none gives way to the one from before, as all does at Escape.
    void entered(glm::dvec3 srgb);

  protected:
    void changeEvent(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void enter();

    glm::dvec3 mColour{0};
};

}  // namespace tessera
