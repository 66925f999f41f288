// See edit_actions.h.
#include "app/edit_actions.h"

#include <QLocale>
#include <algorithm>
#include <array>
#include <set>

#include "app/message.h"
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

tl::unexpected<Error> noCurves() {
    return refused(QObject::tr("Select curves with the direct-selection tool first."));
}

// What an edit of several elements, one by one, has come to.
struct Tally {
    size_t of = 0;
    size_t left = 0;
    std::string why;  // what was said of the first one left

    void leave(const std::string& reason) {
        if (left++ == 0) why = reason;
    }
    QString remark() const {
        if (left == 0) return {};
        return QObject::tr("%1 of %2 were left as they are: %3")
            .arg(QLocale().toString(qulonglong(left)), QLocale().toString(qulonglong(of)), asSentence(why));
    }
};

// Applies an edit that keeps such a tally. It fails where it has left all.
Result<QString> applyToEach(DocumentSession& session, const QString& text, size_t count,
                            const std::function<Touched(PatchMesh&, Tally&)>& edit) {
    Tally tally;
    tally.of = count;
    const Result<void> done = apply(session, text, [&](PatchMesh& mesh) -> Result<Touched> {
        const Touched touched = edit(mesh, tally);
        if (tally.left == tally.of) return failure(ErrorCode::Usage, tally.why);
        return touched;
    });
    if (!done) return tl::unexpected<Error>(done.error());
    return tally.remark();
}

// `edit` changes one element, or fails and changes nothing.
template <class Id, class Edit>
Touched editEach(PatchMesh& mesh, std::span<const Id> ids, Tally& tally, Edit&& edit) {
    std::vector<VertexId> vertices;
    std::vector<EdgeId> edges;
    std::vector<PatchId> patches;
    bool topology = false;
    for (const Id id : ids) {
        const Result<Touched> touched = edit(mesh, id);
        if (!touched) {
            tally.leave(touched.error().message);
            continue;
        }
        vertices.insert(vertices.end(), touched->vertices.begin(), touched->vertices.end());
        edges.insert(edges.end(), touched->edges.begin(), touched->edges.end());
        patches.insert(patches.end(), touched->patches.begin(), touched->patches.end());
        topology = topology || touched->topology;
    }
    Touched all = touchedOf(std::move(vertices), std::move(edges), std::move(patches));
    all.topology = topology;
    return all;
}

Result<QString> editEachCurve(DocumentSession& session, const QString& text,
                              Result<Touched> (*edit)(PatchMesh&, EdgeId)) {
    const std::vector<EdgeId> curves = session.selection().curves();
    if (curves.empty()) return noCurves();
    return applyToEach(session, text, curves.size(), [&](PatchMesh& mesh, Tally& tally) {
        return editEach(mesh, std::span(curves), tally, edit);
    });
}

// Curves that have ends in common, together.
std::vector<std::vector<EdgeId>> connectedParts(const HalfedgeMesh& mesh, const std::vector<EdgeId>& curves) {
    std::set<EdgeId> left(curves.begin(), curves.end());
    std::vector<std::vector<EdgeId>> parts;
    while (!left.empty()) {
        std::vector<EdgeId> part{left.extract(left.begin()).value()};
        for (size_t i = 0; i < part.size(); ++i)
            for (const HalfedgeId h :
                 {HalfedgeMesh::halfedge(part[i]), HalfedgeMesh::twin(HalfedgeMesh::halfedge(part[i]))})
                mesh.forEachOutgoing(mesh.origin(h), [&](HalfedgeId next) {
                    if (left.erase(HalfedgeMesh::edge(next)) > 0) part.push_back(HalfedgeMesh::edge(next));
                });
        parts.push_back(std::move(part));
    }
    return parts;
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
        editPatches(session, textOf(flag, on),
                    [&](PatchMesh& mesh, const PatchSet& set) { return setFlags(mesh, set, flag, on); });
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

Result<QString> setFeature(DocumentSession& session, bool feature) {
    std::vector<EdgeId> curves = session.selection().curves();
    if (curves.empty()) return noCurves();
    const QString text = feature ? QObject::tr("Mark Feature") : QObject::tr("Unmark Feature");
    return applyToEach(session, text, curves.size(), [&](PatchMesh& mesh, Tally& tally) -> Touched {
        std::erase_if(curves, [&](EdgeId e) {
            const bool border = mesh.connectivity().onBorder(e);
            if (border) tally.leave(QObject::tr("the picture's border is no feature").toStdString());
            return border;
        });
        return setFeature(mesh, curves, feature).value_or(Touched{});
    });
}

Result<void> setBlur(DocumentSession& session, double sigmaStart, double sigmaEnd) {
    const std::vector<EdgeId> curves = session.selection().curves();
    if (curves.empty()) return noCurves();
    return apply(session, QObject::tr("Blur"),
                 [&](PatchMesh& mesh) { return setBlur(mesh, curves, sigmaStart, sigmaEnd); });
}

Result<QString> snapToFeature(DocumentSession& session) {
    const auto photo = photoOf(session);
    if (!photo) return tl::unexpected<Error>(photo.error());
    const std::vector<EdgeId> curves = session.selection().curves();
    if (curves.empty()) return noCurves();
    const auto snapAlone = [&](PatchMesh& mesh, EdgeId e) {
        return snapToFeature(mesh, **photo, std::array{e});
    };
    return applyToEach(
        session, QObject::tr("Snap to Feature"), curves.size(), [&](PatchMesh& mesh, Tally& tally) {
            Touched all;
            for (const std::vector<EdgeId>& part : connectedParts(mesh.connectivity(), curves)) {
                // A curve that cannot move must not hold up those that it meets.
                const Result<Touched> touched = snapToFeature(mesh, **photo, part);
                all = united(all, touched ? *touched : editEach(mesh, std::span(part), tally, snapAlone));
            }
            return all;
        });
}

Result<QString> splitCurves(DocumentSession& session) {
    return editEachCurve(session, QObject::tr("Split Curve"),
                         [](PatchMesh& mesh, EdgeId e) { return splitEdge(mesh, e, .5); });
}

Result<QString> mergeCurves(DocumentSession& session) {
    return editEachCurve(session, QObject::tr("Merge"), [](PatchMesh& mesh, EdgeId e) -> Result<Touched> {
        // One that went with the merge of another needs none of its own.
        if (!mesh.connectivity().alive(e)) return Touched{};
        return mergeEdge(mesh, e);
    });
}

Result<QString> splitPatches(DocumentSession& session) {
    const PatchSet patches = session.selection().patches();
    if (patches.empty()) return noPatches();
    constexpr Barycentric kCentre(1. / 3, 1. / 3, 1. / 3);
    const auto split = [&](PatchMesh& mesh, PatchId p) { return splitPatch(mesh, p, kCentre); };
    return applyToEach(
        session, QObject::tr("Split Patch"), patches.size(),
        [&](PatchMesh& mesh, Tally& tally) { return editEach(mesh, std::span(patches), tally, split); });
}

}  // namespace tessera
