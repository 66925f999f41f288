// The edits of menus and panels: each is one step of the history, on what is selected.
#pragma once

#include "app/edit_session.h"
#include "core/edit/recolour.h"

namespace tessera {

// All return what failed as one sentence, and then change nothing; no selection of the right kind is a
// failure too (Usage). Edits that take longer are in element_edits.h.

// In one go; RecolourGesture is for sliders.
Result<void> recolourSelection(DocumentSession& session, const QString& text, const Recolouring& how,
                               const RecolourOptions& options = {});

enum class PatchFlag { Hidden, Locked, CutOut };

// Of the selected patches. Hidden and locked ones cannot be selected, so they leave the selection.
Result<void> setFlag(DocumentSession& session, PatchFlag flag, bool on);
// Of all patches of the picture: "show all", "unlock all".
Result<void> clearFlag(DocumentSession& session, PatchFlag flag);

// Back to the mesh as it was vectorized. Fails where nothing has been edited, and where the connectivity of
// all of the selected patches is another one since.
Result<void> resetColours(DocumentSession& session);
Result<void> resetShape(DocumentSession& session);

}  // namespace tessera
