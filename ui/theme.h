// The program's own light and dark looks: neutral greys, so that the frame does not tint how a picture is
// seen.
#pragma once

#include <QColor>

#include "app/settings.h"

class QApplication;

namespace tessera {

// What the canvas paints around and behind the picture.
struct CanvasColours {
    QColor ground;
    QColor frame;  // the line around the picture
    QColor checkLight;
    QColor checkDark;
    QColor hint;  // text on the ground
};

CanvasColours canvasColours(Theme theme);

// Dark or Light: what System comes to, by the palette that the desktop gave the program at its start. (Qt 6.4
// has no better way to ask.)
Theme shownTheme(Theme theme);

// Sets style, palette and style sheet of the whole program.
void applyTheme(QApplication& application, Theme theme);

}  // namespace tessera
