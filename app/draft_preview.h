// What the current photo would look like with other numbers of patches, while a slider runs through them.
#pragma once

#include <QObject>
#include <QPointer>
#include <map>
#include <optional>

#include "app/workspace.h"
#include "core/vectorize/draft_ladder.h"

namespace tessera {

// A session's first wish has a ladder of drafts built, which takes about as long as a draft; from then on a
// draft is there within a frame or two, until the session closes or gets another photo. The newest wish wins.
// Nothing of it becomes part of the document; a change of the document's mesh ends it.
class DraftPreview : public QObject {
    Q_OBJECT

  public:
    explicit DraftPreview(Workspace& workspace, QObject* parent = nullptr);

    // Null for none.
    void setSession(DocumentSession* session);
    // Asks for the draft with these patches and this share of features. Nothing happens without a photo, or
    // where the method has no drafts.
    void want(const VectorizeSettings& settings);
    // Back to the document.
    void drop();

    // The draft to be shown; none while nobody wants one.
    const std::optional<PatchMesh>& mesh() const { return mMesh; }

  signals:
    // mesh() is another one.
    void changed();

  private:
    struct Drafts {
        std::shared_ptr<const DraftLadder> ladder;
        VectorizeSettings settings;  // that it was built with
        bool building = false;
    };

    Drafts& draftsOf(DocumentSession& session);
    bool serves(const Drafts& drafts) const;
    void build(Drafts& drafts);
    void drawNext();
    void forgetWish();

    Workspace& mWorkspace;
    QPointer<DocumentSession> mSession;
    std::optional<VectorizeSettings> mWish;
    bool mWishDrawn = false;
    std::optional<PatchMesh> mMesh;
    std::map<const QObject*, Drafts> mDrafts;  // by session
    QPointer<Job> mRung;
};

}  // namespace tessera
