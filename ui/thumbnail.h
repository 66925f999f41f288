// Small pictures of files, for lists of them.
#pragma once

#include <QImage>
#include <QSize>
#include <QString>

namespace tessera {

// The preview in a Tessera document, or the picture in the file scaled down, no larger than `bounds`; null
// where there is none. Reads whole files: for workers.
QImage thumbnailOf(const QString& path, QSize bounds);

}  // namespace tessera
