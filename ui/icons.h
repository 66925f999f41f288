// The program's own line icons (resources/icons/line), in the colours of the theme.
#pragma once

#include <QIcon>
#include <QPalette>
#include <QStringList>

namespace tessera {

// Drawn anew at every size and pixel ratio, hence sharp; best at 24 px, whose grid it is drawn on. In the
// palette's text colour; its highlight's where checked, the disabled text's where disabled, and on the
// highlight (a chosen menu entry) the highlighted text's. `name` must be one of iconNames().
QIcon icon(const QString& name, const QPalette& palette);

QStringList iconNames();

}  // namespace tessera
