// See refit.h.
#include "core/edit/refit.h"

#include <algorithm>
#include <utility>

#include "core/base/check.h"
#include "core/edit/site_fit.h"
#include "core/vectorize/solve_colors.h"

namespace tessera {

namespace {

// Seams count this much against a pixel: about as much as a solve of the whole picture comes to.
constexpr double kSeamWeight = 1;

// The centres that a patch has; those of splines without sites are made anew.
SiteChoice choiceOf(const PatchSpline& spline, int channels) {
    SiteChoice choice;
    choice.sites =
        spline.sites.empty() ? usualSites() : std::vector<uint8_t>(spline.sites.begin(), spline.sites.end());
    for (size_t c = 0; c < size_t(channels); ++c)
        choice.terms[c] = spline.sites.empty() ? int(choice.sites.size()) : std::max<int>(3, spline.terms[c]);
    return choice;
}

}  // namespace

Result<Touched> refitColours(PatchMesh& mesh, const Image& photo, const PatchSet& set,
                             const ProgressPart& progress) {
    TESSERA_CHECK(photo.width() == mesh.width() && photo.height() == mesh.height() &&
                  photo.channels() == mesh.channels());
    const HalfedgeMesh& c = mesh.connectivity();
    PatchSet patches = alive(mesh, set);
    for (const PatchId p : alive(mesh, set))
        for (const HalfedgeId side : c.sides(p))
            if (c.face(HalfedgeMesh::twin(side)).valid()) patches.push_back(c.face(HalfedgeMesh::twin(side)));
    patches = editable(mesh, patchSet(std::move(patches)));
    if (patches.empty()) return Touched{};
    std::vector<SiteChoice> choices(c.faceCapacity());
    for (const PatchId p : patches) choices[p.index] = choiceOf(mesh.spline(p), mesh.channels());
    return refitColors(mesh, FitPicture(inBasis(photo, mesh.colourBasis())), choices,
                       VectorizeSettings{}.seamGradientWeight, kSeamWeight, progress)
        .map([](std::vector<PatchId> solved) {
            Touched touched;
            touched.patches = std::move(solved);
            return touched;
        });
}

Touched refitColours(PatchMesh& mesh, const Image& photo, const PatchSet& set) {
    Progress never;
    return *refitColours(mesh, photo, set, ProgressPart(never));
}

}  // namespace tessera
