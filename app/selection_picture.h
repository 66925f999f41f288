// The selected patches as a picture for the clipboard.
#pragma once

#include <QImage>

#include "app/document_session.h"

namespace tessera {

// At one pixel for each of the picture's, just as large as the selection, transparent beside it
// (anti-aliased); the whole picture where no patch is selected. Null where there are no patches.
QImage selectionPicture(const DocumentSession& session);

}  // namespace tessera
