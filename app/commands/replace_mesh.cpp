// See replace_mesh.h.
#include "app/commands/replace_mesh.h"

#include <QObject>

namespace tessera {

ReplaceMesh::ReplaceMesh(DocumentSession& session, Document after)
    : mSession(session), mOther(std::move(after)), mOtherRevision(session.newRevision()) {
    setText(QObject::tr("Vectorize"));
}

}  // namespace tessera
