// Edits of each of what is selected, which take long where that is much: prepared from a document, then made
// at once or by a job.
#pragma once

#include <functional>
#include <memory>

#include "app/edit_session.h"
#include "core/base/progress.h"
#include "core/edit/recolour.h"

namespace tessera {

struct EditedElements {
    Touched touched;
    QString remark;  // one sentence about those that were left as they are; empty where there are none
};

struct ElementEdit {
    QString text;      // of the step
    size_t count = 0;  // of elements: how much work it is
    // Needs nothing but the mesh. Fails, and then changes nothing that is used, where no element can be
    // edited, and with Stopped.
    std::function<Result<EditedElements>(PatchMesh&, Progress&)> run;
};

// These fail (Usage) where nothing of the right kind is selected, or the photo is missing that they need.

// At the middle.
Result<ElementEdit> splitPatches(const DocumentSession& session);
Result<ElementEdit> splitCurves(const DocumentSession& session);
Result<ElementEdit> mergeCurves(const DocumentSession& session);
// Of the selected curves. Their vertices and handles do not count.
Result<ElementEdit> setFeature(const DocumentSession& session, bool feature);
// Curves that follow each other move together where they can.
Result<ElementEdit> snapToFeature(const DocumentSession& session);
// Of the selected patches, from the photo.
Result<ElementEdit> refitColours(const DocumentSession& session);

// What `recolourer`, which nobody else uses meanwhile, does to a set of so many patches, exactly.
ElementEdit exactRecolouring(const QString& text, std::shared_ptr<const Recolourer> recolourer,
                             const Recolouring& how, size_t patches);

// Makes the edit as one step, here and now; returns its remark.
Result<QString> makeNow(DocumentSession& session, const Result<ElementEdit>& edit);

// Ends a gesture by one step, the edit of its start state, of which it has shown something near. Until then
// it stays open and shows that. `then`, where given, hears what the step has touched: nothing where none was
// made.
using EditThen = std::function<void(const Touched&)>;
using FinishGesture = std::function<void(std::shared_ptr<EditSession>, ElementEdit, EditThen)>;

// Here and now. Workspace::finish() has a job do what takes longer.
void finishNow(std::shared_ptr<EditSession> gesture, const ElementEdit& edit, const EditThen& then);

}  // namespace tessera
