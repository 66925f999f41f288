// Edits of each of what is selected, which take long where that is much: prepared from a document, then made
// at once or by a job.
#pragma once

#include <functional>

#include "app/edit_session.h"
#include "core/base/progress.h"

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

// Makes the edit as one step, here and now; returns its remark.
Result<QString> makeNow(DocumentSession& session, const Result<ElementEdit>& edit);

}  // namespace tessera
