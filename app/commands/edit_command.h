// The one undoable command: another state of the document, swapped in and out.
#pragma once

#include <QString>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "app/change.h"
#include "app/photo.h"
#include "core/document/document.h"

namespace tessera {

class DocumentSession;

// Holds the state of the document that is not the current one and exchanges the two, so that undo and redo
// are one operation and undo gives back the very same value. Documents share pages of the mesh and all else
// that is large: a command costs what differs.
class EditCommand {
  public:
    // `after` takes the place of the session's document at the first swap(), which announces `change`, and so
    // does each later one. The session outlives its commands.
    // A photo takes the place of the session's too.
    EditCommand(DocumentSession& session, QString text, Document after, Change change,
                std::optional<Photo> photo = {});

    const QString& text() const { return mText; }
    // The revision of the state that is held.
    uint64_t otherRevision() const { return mOtherRevision; }
    // What the held state costs beyond the current one, in bytes.
    size_t bytes() const { return mDone ? mBytesBefore : mBytesAfter; }
    void swap();
    // This step and the one right after it as one; both are done and are edits of the mesh.
    void join(const EditCommand& next);

  private:
    DocumentSession& mSession;
    QString mText;
    Document mOther;
    uint64_t mOtherRevision;
    std::optional<Photo> mOtherPhoto;  // where the step is about it
    Change mChange;
    size_t mBytesBefore;  // of the state before that the state after does not share
    size_t mBytesAfter;   // and the other way round
    bool mDone = false;
};

}  // namespace tessera
