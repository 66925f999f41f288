// Opens a file by what it holds, whatever its name: a picture or a Tessera document.
#pragma once

#include <QString>

#include "app/document_session.h"
#include "core/base/progress.h"
#include "core/base/result.h"

namespace tessera {

struct OpenedFile {
    Document document;  // without patches where the file is a picture
    Photo photo;        // of a document: the embedded one, or the one beside the file if it is still the same
    QString path;       // the document's; empty for a picture
};

// Reads and decodes; for workers. Fails with what core says of the file, or CannotRead.
Result<OpenedFile> openFile(const QString& path, Progress& progress);

// A picture that has no file, as a document of its PNG. Fails with CannotRead where it is empty.
Result<OpenedFile> openPasted(const QImage& picture, Progress& progress);

// The endings of the files that the open dialog offers, as a filter of QFileDialog.
QString openFilter();

}  // namespace tessera
