// See edit_actions.h.
#include "app/edit_actions.h"

#include <algorithm>

#include "core/edit/drag_colour.h"
#include "core/edit/reshape.h"

namespace tessera {

namespace {

Result<void> apply(DocumentSession& session, const QString& text, const MeshEdit& edit) {
    const Result<Touched> touched = applyEdit(session, text, edit);
    if (!touched) return tl::unexpected<Error>(touched.error());
    return {};
}

Result<void> editPatches(DocumentSession& session, const QString& text,
                         const std::function<Result<Touched>(PatchMesh&, const PatchSet&)>& edit) {
    const auto patches = selectedPatches(session);
    if (!patches) return tl::unexpected<Error>(patches.error());
    return apply(session, text, [&](PatchMesh& mesh) { return edit(mesh, *patches); });
}

bool& valueOf(PatchAttributes& attributes, PatchFlag flag) {
    switch (flag) {
        case PatchFlag::Hidden:
            return attributes.hidden;
        case PatchFlag::Locked:
            return attributes.locked;
        case PatchFlag::CutOut:
            break;
    }
    return attributes.cutOut;
}

QString textOf(PatchFlag flag, bool on) {
    switch (flag) {
        case PatchFlag::Hidden:
            return on ? QObject::tr("Hide") : QObject::tr("Show");
        case PatchFlag::Locked:
            return on ? QObject::tr("Lock") : QObject::tr("Unlock");
        case PatchFlag::CutOut:
            break;
    }
    return on ? QObject::tr("Cut Out") : QObject::tr("Fill In");
}

Touched setFlags(PatchMesh& mesh, const PatchSet& patches, PatchFlag flag, bool on) {
    Touched touched;
    for (const PatchId p : patches) {
        PatchAttributes attributes = mesh.attributes(p);
        if (valueOf(attributes, flag) == on) continue;
        valueOf(attributes, flag) = on;
        mesh.setAttributes(p, attributes);
        touched.patches.push_back(p);
    }
    return touched;
}

using Reset = Touched (*)(PatchMesh&, const PatchMesh&, const PatchSet&);

Result<void> reset(DocumentSession& session, const QString& text, Reset how) {
    const std::optional<PatchMesh> fitted = session.document().fitted;
    if (!fitted) return refused(QObject::tr("Nothing has been edited since the picture was vectorized."));
    return editPatches(session, text, [&](PatchMesh& mesh, const PatchSet& set) -> Result<Touched> {
        if (std::none_of(set.begin(), set.end(), [&](PatchId p) { return hasFitted(mesh, *fitted, p); }))
            return refused(
                QObject::tr("These patches have been split or merged since the picture was "
                            "vectorized, so there is nothing to go back to."));
        return how(mesh, *fitted, set);
    });
}

}  // namespace

Result<void> recolourSelection(DocumentSession& session, const QString& text, const Recolouring& how,
                               const RecolourOptions& options) {
    return editPatches(session, text, [&](PatchMesh& mesh, const PatchSet& set) {
        return recolour(mesh, set, how, options);
    });
}

Result<void> setFlag(DocumentSession& session, PatchFlag flag, bool on) {
    const Result<void> done =
        editPatches(session, textOf(flag, on),
                    [&](PatchMesh& mesh, const PatchSet& set) { return setFlags(mesh, set, flag, on); });
    if (done && on && flag != PatchFlag::CutOut) session.selection().setPatches({});
    return done;
}

Result<void> clearFlag(DocumentSession& session, PatchFlag flag) {
    const QString text = flag == PatchFlag::Hidden   ? QObject::tr("Show All")
                         : flag == PatchFlag::Locked ? QObject::tr("Unlock All")
                                                     : QObject::tr("Fill In All");
    const PatchMarks& marks = session.marks();
    const PatchSet marked = flag == PatchFlag::Hidden   ? marks.hidden()
                            : flag == PatchFlag::Locked ? marks.locked()
                                                        : marks.cutOut();
    return apply(session, text, [&](PatchMesh& mesh) { return setFlags(mesh, marked, flag, false); });
}

Result<void> resetColours(DocumentSession& session) {
    return reset(session, QObject::tr("Reset Colours"), &tessera::resetColours);
}

Result<void> resetShape(DocumentSession& session) {
    return reset(session, QObject::tr("Reset Shape"), &tessera::resetShape);
}

}  // namespace tessera
