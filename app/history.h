// The steps of a document that can be undone, within a limit of memory.
#pragma once

#include <QObject>
#include <deque>

#include "app/commands/edit_command.h"

namespace tessera {

// Like QUndoStack, which can limit the number of steps but not the bytes that they take, and cannot forget
// its oldest step. Here the oldest go as soon as all together hold more than the limit; the last one always
// stays. State i is the document after i of the steps that are kept. While an EditSession is open, undo(),
// redo() and goTo() wait for its end.
class History : public QObject {
    Q_OBJECT

  public:
    explicit History(DocumentSession& session) : mSession(session) {}

    // Drops the steps that have been undone and does this one. No EditSession is open.
    void push(EditCommand command);

    // Makes one step of the last two, both edits of the mesh. Nothing happens where one of them is undone or
    // forgotten, or where the state between them is the one in the file. No EditSession is open.
    void joinLast();

    int count() const { return int(mSteps.size()); }
    int index() const { return mIndex; }  // the state that the document is in, 0..count()
    // Of the step from state `step` to the next.
    const QString& text(int step) const { return mSteps[size_t(step)].text(); }
    bool canUndo() const { return mIndex > 0; }
    bool canRedo() const { return mIndex < count(); }
    QString undoText() const { return canUndo() ? text(mIndex - 1) : QString(); }
    QString redoText() const { return canRedo() ? text(mIndex) : QString(); }
    void undo();
    void redo();
    void goTo(int state);

    uint64_t revision(int state) const;
    // The state that is in the file; -1 where it is not among those kept, and where there is no file yet.
    int savedIndex() const;
    // Whether older steps than those kept have been forgotten.
    bool forgot() const { return mForgot; }

    // What the steps take: the pages that neighbouring states do not share.
    size_t bytes() const;
    size_t memoryLimit() const { return mMemoryLimit; }
    void setMemoryLimit(size_t bytes);

    static constexpr size_t kDefaultMemoryLimit = size_t{512} << 20;

  signals:
    // Steps, index or saved state are others.
    void changed();

  private:
    void moveTo(int state);
    void forgetOldest();

    DocumentSession& mSession;
    std::deque<EditCommand> mSteps;
    int mIndex = 0;
    bool mForgot = false;
    size_t mMemoryLimit = kDefaultMemoryLimit;
};

}  // namespace tessera
