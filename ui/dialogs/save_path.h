// Asks where to write a file.
#pragma once

#include <QString>

class QWidget;

namespace tessera {

// A path with one of the suffixes that `filter` ("JPEG (*.jpg *.jpeg)") lists; the first is added to a name
// that has none of them. What is there may be replaced: that has been asked about the whole name. Empty where
// no file was chosen.
QString askForSavePath(QWidget* parent, const QString& title, const QString& suggested,
                       const QString& filter);

}  // namespace tessera
