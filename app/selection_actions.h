// What menus and panels do with the selection of a document, without a pointer on the canvas.
#pragma once

#include <QString>

#include "app/document_session.h"
#include "core/edit/select.h"

namespace tessera {

void selectAll(DocumentSession& session);
void selectNone(DocumentSession& session);
void invertSelection(DocumentSession& session);
void growSelection(DocumentSession& session);
void shrinkSelection(DocumentSession& session);
// Adds what the wand finds from the selected patches (from those that it has not found already).
void selectSimilar(DocumentSession& session, const WandOptions& options);

// The patches that are selected, or that have a selected curve or point on them.
PatchSet selectionsPatches(const DocumentSession& session);

// Named selections are parts of the document: each of these is a step of the history. Names are not empty and
// all different; storing under a name that exists replaces it. What fails changes nothing.
Result<void> storeSelection(DocumentSession& session, const QString& name);
// Selects what is alive and selectable of it.
void recallSelection(DocumentSession& session, const QString& name, SelectMode mode = SelectMode::Replace);
Result<void> removeStoredSelection(DocumentSession& session, const QString& name);
// Fails where `to` is taken or empty.
Result<void> renameStoredSelection(DocumentSession& session, const QString& from, const QString& to);

}  // namespace tessera
