// See draft_ladder.h.
#include "core/vectorize/draft_ladder.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/mesh/newton_basis.h"
#include "core/vectorize/patch_cells.h"

namespace tessera {

namespace {

constexpr int kTerms = 6;
using Gram = Eigen::Matrix<double, kTerms, kTerms>;
using Factors = Eigen::Matrix<double, kTerms, kMaxChannels>;

// The corners and the middles of the sides.
std::array<uint8_t, kTerms> draftSites() {
    std::array<uint8_t, kTerms> sites{0, 1, 2};
    const auto& all = centreSites();
    for (size_t side = 0; side < 3; ++side) {
        const glm::dvec2 middle = .5 * (all[side] + all[(side + 1) % 3]);
        const auto nearest = std::min_element(all.begin(), all.end(), [&](glm::dvec2 a, glm::dvec2 b) {
            const glm::dvec2 da = a - middle, db = b - middle;
            return da.x * da.x + da.y * da.y < db.x * db.x + db.y * db.y;
        });
        sites[3 + side] = uint8_t(nearest - all.begin());
    }
    return sites;
}

// Of one colour: the picture's in the patch's middle.
Factors constantFactors(const PatchMesh& mesh, PatchId p, const Image& picture) {
    const LatticeTriangle t = mesh.controlPoints(p);
    const glm::dvec2 middle = (toPixels(t.corner(0)) + toPixels(t.corner(1)) + toPixels(t.corner(2))) / 3.0;
    const int x = std::clamp(int(middle.x), 0, picture.width() - 1);
    const int y = std::clamp(int(middle.y), 0, picture.height() - 1);
    Factors factors = Factors::Zero();
    for (int c = 0; c < picture.channels(); ++c)
        factors.col(c).head<3>().setConstant(double(picture.at(x, y, c)));
    return factors;
}

// The least squares over the patch's pixels of what `factors` leave, added to them.
void fitTo(const PatchCells& cells, const Image& picture, const NewtonBasis& basis, Factors& factors) {
    constexpr double kRidge = 1e-4;
    const auto count = Eigen::Index(cells.cells.size());
    Eigen::Matrix<float, kTerms, Eigen::Dynamic, Eigen::RowMajor> rows(kTerms, count);
    basis.evaluate(cells.x.data(), cells.y.data(), size_t(count), rows.data(), size_t(count));
    Eigen::Matrix<float, Eigen::Dynamic, kMaxChannels> targets(count, kMaxChannels);
    targets.setZero();
    for (int c = 0; c < picture.channels(); ++c) {
        const float base = float(factors(0, c));
        for (Eigen::Index k = 0; k < count; ++k)
            targets(k, c) = picture.plane(c)[cells.cells[size_t(k)].number] - base;
    }
    Gram gram = (rows * rows.transpose()).cast<double>();
    gram.diagonal().array() += kRidge * double(count);
    const Factors moments = (rows * targets).cast<double>();
    factors += gram.llt().solve(moments);
}

void fitColours(const Image& picture, PatchMesh& mesh) {
    const FitGrid grid{picture.width(), picture.height(), 1, {}};
    const CellSampler sampler(mesh, grid, 1);
    const std::array<uint8_t, kTerms> sites = draftSites();
    const NewtonBasis basis(sites);
    std::vector<Factors> factors(mesh.connectivity().faceCapacity());
    mesh.forEachPatch([&](PatchId p) { factors[p.index] = constantFactors(mesh, p, picture); });
    parallelFor(sampler.patches().size(), 4, [&](size_t begin, size_t end) {
        PatchCells cells;
        for (size_t i = begin; i < end; ++i) {
            sampler.sample(i, cells);
            if (!cells.cells.empty()) fitTo(cells, picture, basis, factors[sampler.patches()[i].index]);
        }
    });
    mesh.setColourBasis(ColourBasis::Opponent);
    mesh.forEachPatch([&](PatchId p) {
        std::array<std::span<const double>, kMaxChannels> own;
        for (int c = 0; c < mesh.channels(); ++c) own[size_t(c)] = {factors[p.index].col(c).data(), kTerms};
        mesh.setSpline(p, basis.spline({own.data(), size_t(mesh.channels())}));
    });
}

// Feature edges become straight ones as all others are; what is certified stays so, as base triangles are
// positive.
void dropFeatures(CutMesh& cut) {
    cut.curves.clear();
    cut.curveOfEdge.clear();
    const LatticePoint far{cut.width * kLatticePerPixel, cut.height * kLatticePerPixel};
    for (size_t v = 0; v < cut.kinds.size(); ++v) {
        const LatticePoint p = cut.positions[v];
        const bool onSide = p.x == 0 || p.x == far.x, onEnd = p.y == 0 || p.y == far.y;
        cut.kinds[v] = onSide && onEnd   ? VertexKind::Corner
                       : onSide || onEnd ? VertexKind::Border
                                         : VertexKind::Interior;
    }
}

}  // namespace

void DraftLadder::descend(CutMesh& cut, size_t collapses) const {
    for (size_t i = 0; i < collapses; ++i) {
        if (i == mWithFeatures) dropFeatures(cut);
        apply(mCollapses[i], cut);
    }
}

Result<std::shared_ptr<const DraftLadder>> DraftLadder::build(CutMesh initial,
                                                              std::shared_ptr<const Image> sharp,
                                                              const PolynomialFit& fit,
                                                              const VectorizeSettings& settings,
                                                              Progress& progress) {
    std::shared_ptr<DraftLadder> ladder(new DraftLadder);
    auto& collapses = ladder->mCollapses;
    constexpr size_t kHandful = 8;
    const auto collapse = [&](CutMesh& cut) {
        Refiner refiner(cut, fit, settings, progress.stopToken());
        refiner.recordTo(collapses);
        return refiner.collapseTo(kHandful, progress);
    };
    CutMesh collapsed = initial;
    if (!collapse(collapsed)) return stopped();
    ladder->mWithFeatures = collapses.size();
    if (const size_t stuck = collapsed.mesh.faceCount(); stuck > kHandful) {
        // Features hold the last rungs before that at meshes that are worse than those without.
        constexpr double kRoom = 1.3;
        collapsed = initial;
        size_t kept = 0;
        while (kept < collapses.size() && double(collapsed.mesh.faceCount()) > kRoom * double(stuck))
            apply(collapses[kept++], collapsed);
        collapses.resize(kept);
        ladder->mWithFeatures = kept;
        dropFeatures(collapsed);
        if (!collapse(collapsed)) return stopped();
    }
    // The chains served to fit curves, which the collapses hold.
    initial.chains.clear();
    CutMesh counted = initial;
    ladder->mFaces.push_back(counted.mesh.faceCount());
    for (const RecordedCollapse& next : collapses) {
        if (ladder->mFaces.size() == ladder->mWithFeatures + 1) dropFeatures(counted);
        apply(next, counted);
        ladder->mFaces.push_back(counted.mesh.faceCount());
    }
    ladder->mInitial = std::move(initial);
    ladder->mSharp = std::move(sharp);
    return ladder;
}

PatchMesh DraftLadder::at(size_t patches) const {
    CutMesh cut = mInitial;
    const auto rung =
        std::find_if(mFaces.begin(), mFaces.end() - 1, [&](size_t faces) { return faces <= patches; });
    descend(cut, size_t(rung - mFaces.begin()));
    PatchMesh mesh = toPatchMesh(cut, mSharp->channels());
    fitColours(*mSharp, mesh);
    return mesh;
}

}  // namespace tessera
