// See edit_actions.h.
#include "app/edit_actions.h"

#include <algorithm>

#include "core/edit/drag_colour.h"
#include "core/edit/edge_edits.h"
#include "core/edit/refit.h"
#include "core/edit/reshape.h"
#include "core/edit/snap.h"
#include "core/edit/split_merge.h"

namespace tessera {

namespace {

tl::unexpected<Error> refused(const QString& why) {
    return failure(ErrorCode::Usage, why.toStdString());
}

tl::unexpected<Error> noPatches() {
    return refused(QObject::tr("Select patches first."));
}

Result<void> apply(DocumentSession& session, const QString& text, const MeshEdit& edit) {
    const Result<Touched> touched = applyEdit(session, text, edit);
    if (!touched) return tl::unexpected<Error>(touched.error());
    return {};
}

Result<void> editPatches(DocumentSession& session, const QString& text,
                         const std::function<Result<Touched>(PatchMesh&, const PatchSet&)>& edit) {
    const PatchSet patches = session.selection().patches();
    if (patches.empty()) return noPatches();
    return apply(session, text, [&](PatchMesh& mesh) { return edit(mesh, patches); });
}

Result<void> editCurves(DocumentSession& session, const QString& text,
                        const std::function<Result<Touched>(PatchMesh&, std::span<const EdgeId>)>& edit) {
    const std::vector<EdgeId> curves = session.selection().curves();
    if (curves.empty()) return refused(QObject::tr("Select curves with the direct-selection tool first."));
    return apply(session, text, [&](PatchMesh& mesh) { return edit(mesh, curves); });
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
            return refused(QObject::tr("These patches have been split or merged since the picture was "
                                       "vectorized, so there is nothing to go back to."));
        return how(mesh, *fitted, set);
    });
}

Result<std::shared_ptr<const Image>> photoOf(const DocumentSession& session) {
    if (!session.photo().image)
        return refused(QObject::tr("The photo of this document is missing; relink it first."));
    return session.photo().image;
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
        editPatches(session, textOf(flag, on), [&](PatchMesh& mesh, const PatchSet& set) {
            return setFlags(mesh, set, flag, on);
        });
    if (done && on && flag != PatchFlag::CutOut) session.selection().setPatches({});
    return done;
}

Result<void> clearFlag(DocumentSession& session, PatchFlag flag) {
    const QString text = flag == PatchFlag::Hidden   ? QObject::tr("Show All")
                         : flag == PatchFlag::Locked ? QObject::tr("Unlock All")
                                                     : QObject::tr("Fill In All");
    return apply(session, text, [&](PatchMesh& mesh) {
        PatchSet all;
        mesh.forEachPatch([&](PatchId p) { all.push_back(p); });
        return setFlags(mesh, all, flag, false);
    });
}

Result<void> resetColours(DocumentSession& session) {
    return reset(session, QObject::tr("Reset Colours"), &tessera::resetColours);
}

Result<void> resetShape(DocumentSession& session) {
    return reset(session, QObject::tr("Reset Shape"), &tessera::resetShape);
}

Result<void> refitColours(DocumentSession& session) {
    const auto photo = photoOf(session);
    if (!photo) return tl::unexpected<Error>(photo.error());
    return editPatches(session, QObject::tr("Refit Colours"), [&](PatchMesh& mesh, const PatchSet& set) {
        return refitColours(mesh, **photo, set);
    });
}

Result<void> setFeature(DocumentSession& session, bool feature) {
    return editCurves(session, feature ? QObject::tr("Mark Feature") : QObject::tr("Unmark Feature"),
                      [&](PatchMesh& mesh, std::span<const EdgeId> curves) {
                          return setFeature(mesh, curves, feature);
                      });
}

Result<void> setBlur(DocumentSession& session, double sigmaStart, double sigmaEnd) {
    return editCurves(session, QObject::tr("Blur"), [&](PatchMesh& mesh, std::span<const EdgeId> curves) {
        return setBlur(mesh, curves, sigmaStart, sigmaEnd);
    });
}

Result<void> snapToFeature(DocumentSession& session) {
    const auto photo = photoOf(session);
    if (!photo) return tl::unexpected<Error>(photo.error());
    return editCurves(session, QObject::tr("Snap to Feature"),
                      [&](PatchMesh& mesh, std::span<const EdgeId> curves) {
                          return snapToFeature(mesh, **photo, curves);
                      });
}

Result<void> splitCurves(DocumentSession& session) {
    return editCurves(session, QObject::tr("Split Curve"),
                      [](PatchMesh& mesh, std::span<const EdgeId> curves) -> Result<Touched> {
                          Touched all;
                          for (const EdgeId e : curves) {
                              const Result<Touched> touched = splitEdge(mesh, e, .5);
                              if (!touched) return touched;
                              all = united(all, *touched);
                          }
                          return all;
                      });
}

Result<void> mergeCurves(DocumentSession& session) {
    return editCurves(session, QObject::tr("Merge"),
                      [](PatchMesh& mesh, std::span<const EdgeId> curves) -> Result<Touched> {
                          Touched all;
                          for (const EdgeId e : curves) {
                              // One that went with the merge of another needs none of its own.
                              if (!mesh.connectivity().alive(e)) continue;
                              const Result<Touched> touched = mergeEdge(mesh, e);
                              if (!touched) return touched;
                              all = united(all, *touched);
                          }
                          return all;
                      });
}

Result<void> splitPatches(DocumentSession& session) {
    constexpr Barycentric kCentre(1. / 3, 1. / 3, 1. / 3);
    return editPatches(session, QObject::tr("Split Patch"),
                       [&](PatchMesh& mesh, const PatchSet& set) -> Result<Touched> {
                           Touched all;
                           for (const PatchId p : set) {
                               const Result<Touched> touched = splitPatch(mesh, p, kCentre);
                               if (!touched) return touched;
                               all = united(all, *touched);
                           }
                           return all;
                       });
}

}  // namespace tessera
