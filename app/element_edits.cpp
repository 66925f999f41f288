// See element_edits.h.
#include "app/element_edits.h"

#include <QLocale>
#include <array>
#include <set>
#include <span>

#include "app/message.h"
#include "core/edit/edge_edits.h"
#include "core/edit/refit.h"
#include "core/edit/snap.h"
#include "core/edit/split_merge.h"

namespace tessera {

namespace {

Result<std::shared_ptr<const Image>> photoOf(const DocumentSession& session) {
    if (!session.photo().image)
        return refused(QObject::tr("The photo of this document is missing; relink it first."));
    return session.photo().image;
}

// What an edit of several elements, one by one, has come to, and whether it shall go on.
class Tally {
  public:
    Tally(size_t of, Progress& progress) : mOf(of), mProgress(progress) {}

    void leave(const std::string& reason) {
        if (mLeft++ == 0) mWhy = reason;
    }
    // One more has been looked at; false once the work shall stop.
    bool next() { return mProgress.step(double(++mDone) / double(mOf)); }

    Result<EditedElements> edited(Touched touched) const {
        if (mProgress.stopRequested()) return failure(ErrorCode::Stopped, "stopped");
        if (mLeft == mOf) return failure(ErrorCode::Usage, mWhy);
        return EditedElements{std::move(touched), remark()};
    }

  private:
    QString remark() const {
        if (mLeft == 0) return {};
        return QObject::tr("%1 of %2 were left as they are: %3")
            .arg(QLocale().toString(qulonglong(mLeft)), QLocale().toString(qulonglong(mOf)),
                 asSentence(mWhy));
    }

    size_t mOf;
    size_t mDone = 0;
    size_t mLeft = 0;
    std::string mWhy;  // what was said of the first one left
    Progress& mProgress;
};

// What many edits touch together, united once.
class TouchedSum {
  public:
    void add(const Touched& touched) {
        mVertices.insert(mVertices.end(), touched.vertices.begin(), touched.vertices.end());
        mEdges.insert(mEdges.end(), touched.edges.begin(), touched.edges.end());
        mPatches.insert(mPatches.end(), touched.patches.begin(), touched.patches.end());
        mTopology = mTopology || touched.topology;
    }
    Touched take() {
        Touched all = touchedOf(std::move(mVertices), std::move(mEdges), std::move(mPatches));
        all.topology = mTopology;
        return all;
    }

  private:
    std::vector<VertexId> mVertices;
    std::vector<EdgeId> mEdges;
    std::vector<PatchId> mPatches;
    bool mTopology = false;
};

// `edit` changes one element, or fails and changes nothing.
template <class Id, class Edit>
void editEach(PatchMesh& mesh, std::span<const Id> ids, Tally& tally, TouchedSum& sum, Edit&& edit) {
    for (const Id id : ids) {
        const Result<Touched> touched = edit(mesh, id);
        if (touched)
            sum.add(*touched);
        else
            tally.leave(touched.error().message);
        if (!tally.next()) return;
    }
}

template <class Id, class Edit>
ElementEdit forEach(const QString& text, std::vector<Id> ids, Edit edit) {
    const size_t count = ids.size();
    return {text, count, [ids = std::move(ids), edit](PatchMesh& mesh, Progress& progress) {
                progress.beginStage("", 1);
                Tally tally(ids.size(), progress);
                TouchedSum sum;
                editEach(mesh, std::span(ids), tally, sum, edit);
                return tally.edited(sum.take());
            }};
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

}  // namespace

Result<ElementEdit> splitPatches(const DocumentSession& session) {
    return selectedPatches(session).map([](PatchSet patches) {
        constexpr Barycentric kCentre(1. / 3, 1. / 3, 1. / 3);
        return forEach(QObject::tr("Split Patch"), std::move(patches),
                       [=](PatchMesh& mesh, PatchId p) { return splitPatch(mesh, p, kCentre); });
    });
}

Result<ElementEdit> splitCurves(const DocumentSession& session) {
    return selectedCurves(session).map([](std::vector<EdgeId> curves) {
        return forEach(QObject::tr("Split Curve"), std::move(curves),
                       [](PatchMesh& mesh, EdgeId e) { return splitEdge(mesh, e, .5); });
    });
}

Result<ElementEdit> mergeCurves(const DocumentSession& session) {
    return selectedCurves(session).map([](std::vector<EdgeId> curves) {
        return forEach(QObject::tr("Merge"), std::move(curves),
                       [](PatchMesh& mesh, EdgeId e) -> Result<Touched> {
                           // One that went with the merge of another needs none of its own.
                           if (!mesh.connectivity().alive(e)) return Touched{};
                           return mergeEdge(mesh, e);
                       });
    });
}

Result<ElementEdit> setFeature(const DocumentSession& session, bool feature) {
    return selectedCurves(session).map([feature](std::vector<EdgeId> curves) {
        const size_t count = curves.size();
        const auto run = [curves = std::move(curves), feature](PatchMesh& mesh, Progress& progress) {
            Tally tally(curves.size(), progress);
            std::vector<EdgeId> inside = curves;
            std::erase_if(inside, [&](EdgeId e) {
                const bool border = mesh.connectivity().onBorder(e);
                if (border) tally.leave(QObject::tr("the picture's border is no feature").toStdString());
                return border;
            });
            return tally.edited(setFeature(mesh, inside, feature).value_or(Touched{}));
        };
        return ElementEdit{feature ? QObject::tr("Mark Feature") : QObject::tr("Unmark Feature"), count, run};
    });
}

Result<ElementEdit> snapToFeature(const DocumentSession& session) {
    const auto photo = photoOf(session);
    if (!photo) return tl::unexpected<Error>(photo.error());
    return selectedCurves(session).map([photo = *photo](std::vector<EdgeId> curves) {
        const size_t count = curves.size();
        const auto run = [curves = std::move(curves), photo](PatchMesh& mesh, Progress& progress) {
            progress.beginStage("", 1);
            const auto snapAlone = [&](PatchMesh& m, EdgeId e) {
                return snapToFeature(m, *photo, std::array{e});
            };
            Tally tally(curves.size(), progress);
            TouchedSum sum;
            for (const std::vector<EdgeId>& part : connectedParts(mesh.connectivity(), curves)) {
                if (progress.stopRequested()) break;
                // A curve that cannot move must not hold up those that it meets.
                const Result<Touched> touched = snapToFeature(mesh, *photo, part);
                if (!touched) {
                    editEach(mesh, std::span(part), tally, sum, snapAlone);
                    continue;
                }
                sum.add(*touched);
                for (size_t i = 0; i < part.size(); ++i) tally.next();
            }
            return tally.edited(sum.take());
        };
        return ElementEdit{QObject::tr("Snap to Feature"), count, run};
    });
}

Result<ElementEdit> refitColours(const DocumentSession& session) {
    const auto photo = photoOf(session);
    if (!photo) return tl::unexpected<Error>(photo.error());
    return selectedPatches(session).map([photo = *photo](PatchSet patches) {
        const size_t count = patches.size();
        const auto run = [patches = std::move(patches), photo](PatchMesh& mesh, Progress& progress) {
            progress.beginStage("", 1);
            return refitColours(mesh, *photo, patches, ProgressPart(progress)).map([](Touched touched) {
                return EditedElements{std::move(touched), {}};
            });
        };
        return ElementEdit{QObject::tr("Refit Colours"), count, run};
    });
}

ElementEdit exactRecolouring(const QString& text, std::shared_ptr<const Recolourer> recolourer,
                             const Recolouring& how, size_t patches) {
    // Other edits take as long for one element.
    constexpr size_t kPatchesOfAnElement = 40;
    const auto run = [recolourer = std::move(recolourer), how](PatchMesh& mesh,
                                                               Progress& progress) -> Result<EditedElements> {
        progress.beginStage("", 1);
        EditedElements edited{recolourer->apply(mesh, how), {}};
        if (!progress.step(1)) return stopped();
        return edited;
    };
    return {text, patches / kPatchesOfAnElement, run};
}

void finishNow(std::shared_ptr<EditSession> gesture, const ElementEdit& edit, const EditThen& then) {
    const Result<void> made = gesture->preview([&](PatchMesh& mesh) {
        Progress progress;
        return edit.run(mesh, progress).map([](const EditedElements& edited) { return edited.touched; });
    });
    const Touched touched = made ? gesture->touched() : Touched{};
    gesture->commit();
    if (then) then(touched);
}

Result<QString> makeNow(DocumentSession& session, const Result<ElementEdit>& edit) {
    if (!edit) return tl::unexpected<Error>(edit.error());
    QString remark;
    const auto touched = applyEdit(session, edit->text, [&](PatchMesh& mesh) -> Result<Touched> {
        Progress progress;
        Result<EditedElements> edited = edit->run(mesh, progress);
        if (!edited) return tl::unexpected<Error>(edited.error());
        remark = edited->remark;
        return std::move(edited->touched);
    });
    if (!touched) return tl::unexpected<Error>(touched.error());
    return remark;
}

}  // namespace tessera
