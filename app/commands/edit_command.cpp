// See edit_command.h.
#include "app/commands/edit_command.h"

#include <utility>

#include "app/document_session.h"

namespace tessera {

namespace {

using SharedBytes = std::shared_ptr<const std::vector<uint8_t>>;

size_t bytesBeyond(const SharedBytes& bytes, const SharedBytes& other) {
    return bytes && bytes != other ? bytes->size() : 0;
}

// What `document` takes and does not share with `other`.
size_t bytesBeyond(const Document& document, const Document& other) {
    size_t bytes = sizeof(Document) + document.mesh.bytesBeyond(other.mesh) +
                   document.source.iccProfile.size() +
                   bytesBeyond(document.embeddedSource, other.embeddedSource) +
                   bytesBeyond(document.previewPng, other.previewPng);
    // The first edit makes what was the mesh the fitted one.
    if (document.fitted) bytes += document.fitted->bytesBeyond(other.fitted ? *other.fitted : other.mesh);
    for (const NamedSelection& selection : document.selections)
        bytes += selection.patches.size() * sizeof(PatchId);
    for (const UnknownChunk& chunk : document.unknownChunks) bytes += chunk.bytes.size();
    return bytes;
}

}  // namespace

EditCommand::EditCommand(DocumentSession& session, QString text, Document after, Change change,
                         std::optional<Photo> photo)
    : mSession(session),
      mText(std::move(text)),
      mOther(std::move(after)),
      mOtherRevision(session.newRevision()),
      mOtherPhoto(std::move(photo)),
      mChange(std::move(change)),
      mBytesBefore(bytesBeyond(session.document(), mOther)),
      mBytesAfter(bytesBeyond(mOther, session.document())) {
    if (mOtherPhoto) {
        mBytesBefore += session.photo().imageBytes();
        mBytesAfter += mOtherPhoto->imageBytes();
    }
    mChange.preview = false;
    mChange.saved = true;
}

void EditCommand::join(const EditCommand& next) {
    mChange.touched = united(mChange.touched, next.mChange.touched);
    mChange.selections = mChange.selections || next.mChange.selections;
    mBytesBefore = bytesBeyond(mOther, mSession.document());
    mBytesAfter = bytesBeyond(mSession.document(), mOther);
}

void EditCommand::swap() {
    mDone = !mDone;
    mSession.swapState(mOther, mOtherRevision, mOtherPhoto, mChange);
}

}  // namespace tessera
