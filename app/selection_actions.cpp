// See selection_actions.h.
#include "app/selection_actions.h"

#include <algorithm>

#include "app/edit_session.h"

namespace tessera {

namespace {

const NamedSelection* findStored(const Document& document, const QString& name) {
    const auto found = std::find_if(document.selections.begin(), document.selections.end(),
                                    [&](const NamedSelection& s) { return s.name == name.toStdString(); });
    return found == document.selections.end() ? nullptr : &*found;
}

Result<void> editStored(DocumentSession& session, const QString& text,
                        const std::function<void(std::vector<NamedSelection>&)>& edit) {
    return applyToDocument(session, text, {.selections = true},
                           [&](Document& document) { edit(document.selections); });
}

}  // namespace

void selectAll(DocumentSession& session) {
    session.selection().setPatches(allSelectable(session.document().mesh));
}

void selectNone(DocumentSession& session) {
    session.selection().clear();
}

void invertSelection(DocumentSession& session) {
    session.selection().setPatches(inverted(session.document().mesh, session.selection().patches()));
}

void growSelection(DocumentSession& session) {
    session.selection().setPatches(grown(session.document().mesh, session.selection().patches()));
}

void shrinkSelection(DocumentSession& session) {
    session.selection().setPatches(shrunk(session.document().mesh, session.selection().patches()));
}

void selectSimilar(DocumentSession& session, const WandOptions& options) {
    const PatchMesh& mesh = session.document().mesh;
    const PatchSet seeds = session.selection().patches();
    PatchSet found;
    for (const PatchId seed : seeds)
        if (!contains(found, seed)) found = united(found, wand(mesh, session.colours(), seed, options));
    session.selection().setPatches(united(seeds, found));
}

PatchSet selectionsPatches(const DocumentSession& session) {
    const HalfedgeMesh& mesh = session.document().mesh.connectivity();
    const Selection& selection = session.selection();
    std::vector<PatchId> found = selection.patches();
    const auto addSides = [&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        for (const HalfedgeId side : {h, HalfedgeMesh::twin(h)}) found.push_back(mesh.face(side));
    };
    for (const EdgeId e : selection.curves()) addSides(e);
    for (const ControlPointRef& point : selection.points()) {
        if (point.patch.valid()) found.push_back(point.patch);
        if (point.halfedge.valid()) addSides(HalfedgeMesh::edge(point.halfedge));
        if (point.vertex.valid())
            mesh.forEachOutgoing(point.vertex, [&](HalfedgeId h) { found.push_back(mesh.face(h)); });
    }
    std::erase_if(found, [](PatchId p) { return !p.valid(); });
    return patchSet(std::move(found));
}

Result<void> storeSelection(DocumentSession& session, const QString& name) {
    const PatchSet& patches = session.selection().patches();
    if (name.isEmpty() || patches.empty()) return refused(QObject::tr("Select patches first."));
    return editStored(session, QObject::tr("Store Selection"), [&](std::vector<NamedSelection>& stored) {
        const NamedSelection selection{name.toStdString(), patches};
        const auto old = std::find_if(stored.begin(), stored.end(),
                                      [&](const NamedSelection& s) { return s.name == selection.name; });
        if (old != stored.end())
            *old = selection;
        else
            stored.push_back(selection);
    });
}

void recallSelection(DocumentSession& session, const QString& name, SelectMode mode) {
    const NamedSelection* stored = findStored(session.document(), name);
    if (!stored) return;
    const PatchMesh& mesh = session.document().mesh;
    const PatchSet found = selectableOf(mesh, alive(mesh, stored->patches));
    session.selection().setPatches(combined(session.selection().patches(), found, mode));
}

Result<void> removeStoredSelection(DocumentSession& session, const QString& name) {
    if (!findStored(session.document(), name)) return {};
    return editStored(
        session, QObject::tr("Remove Stored Selection"), [&](std::vector<NamedSelection>& stored) {
            std::erase_if(stored, [&](const NamedSelection& s) { return s.name == name.toStdString(); });
        });
}

Result<void> renameStoredSelection(DocumentSession& session, const QString& from, const QString& to) {
    if (from == to || !findStored(session.document(), from)) return {};
    if (to.isEmpty()) return refused(QObject::tr("A stored selection needs a name."));
    if (findStored(session.document(), to))
        return refused(QObject::tr("There is a selection named “%1” already.").arg(to));
    return editStored(session, QObject::tr("Rename Stored Selection"),
                      [&](std::vector<NamedSelection>& stored) {
                          for (NamedSelection& s : stored)
                              if (s.name == from.toStdString()) s.name = to.toStdString();
                      });
}

}  // namespace tessera
