// The undoable command by which a vectorization takes the place of whatever the document held.
#pragma once

#include <QUndoCommand>
#include <cstdint>

#include "app/document_session.h"

namespace tessera {

// Holds the other state of the document and swaps it in, so that undo and redo are one operation and undo
// gives back the very same value. Documents share what is large: an entry of the history costs what differs.
class ReplaceMesh : public QUndoCommand {
  public:
    // `after` takes the place of the session's document. The session outlives its history.
    ReplaceMesh(DocumentSession& session, Document after);

    void redo() override { swap(); }
    void undo() override { swap(); }

  private:
    void swap() { mSession.swapState(mOther, mOtherRevision); }

    DocumentSession& mSession;
    Document mOther;
    uint64_t mOtherRevision;
};

}  // namespace tessera
