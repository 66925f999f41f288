// See solve_colors.h.
#include "core/vectorize/solve_colors.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <cmath>

#include "core/base/parallel.h"
#include "core/mesh/colour_basis.h"

namespace tessera {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Eigen::VectorXf;

// By patch id; empty where there is no patch.
using PatchVectors = std::vector<VectorXd>;

double dot(const PatchVectors& a, const PatchVectors& b) {
    double sum = 0;
    for (size_t p = 0; p < a.size(); ++p)
        if (a[p].size() > 0) sum += a[p].dot(b[p]);
    return sum;
}

// The normal equations of one channel, A x = b, with patches' first terms alone.
class ChannelSystem {
  public:
    ChannelSystem(const ColorEquations& equations, const std::vector<SiteChoice>& choices, int channel)
        : m(equations),
          mTerms(equations.patches.size(), 0),
          mFactors(equations.patches.size()),
          mPartial(equations.patches.size()),
          mTotals(equations.targets.rows()) {
        mRight.resize(m.patches.size());
        parallelFor(m.patches.size(), 8, [&](size_t begin, size_t end) {
            for (size_t p = begin; p < end; ++p) {
                const auto& patch = m.patches[p];
                if (patch.count == 0) continue;
                const int n = mTerms[p] = choices[p].terms[size_t(channel)];
                VectorXf targets(Eigen::Index(patch.rowIds.size()));
                for (size_t i = 0; i < patch.rowIds.size(); ++i)
                    targets(Eigen::Index(i)) = m.targets(patch.rowIds[i], channel);
                const auto rows = patch.rows.leftCols(n);
                mRight[p] = patch.moments.col(channel).head(n) + (rows.transpose() * targets).cast<double>();
                const Eigen::MatrixXf own = rows.transpose() * rows;
                mFactors[p].compute(patch.gram.topLeftCorner(n, n) + own.cast<double>());
            }
        });
    }

    // Each patch by itself, others' shares in common rows left out: the preconditioner.
    void precondition(const PatchVectors& r, PatchVectors& z) const {
        forPatches([&](size_t p) { z[p] = mFactors[p].solve(r[p]); });
    }

    void apply(const PatchVectors& x, PatchVectors& ax) {
        forPatches([&](size_t p) {
            mPartial[p].noalias() = m.patches[p].rows.leftCols(mTerms[p]) * x[p].cast<float>();
        });
        parallelFor(size_t(mTotals.size()), 4096, [&](size_t begin, size_t end) {
            for (size_t row = begin; row < end; ++row) {
                float sum = 0;
                for (uint32_t i = m.firstEntry[row]; i < m.firstEntry[row + 1]; ++i)
                    sum += mPartial[m.entries[i].patch](m.entries[i].place);
                mTotals(Eigen::Index(row)) = sum;
            }
        });
        forPatches([&](size_t p) {
            const auto& patch = m.patches[p];
            VectorXf totals(Eigen::Index(patch.rowIds.size()));
            for (size_t i = 0; i < patch.rowIds.size(); ++i)
                totals(Eigen::Index(i)) = mTotals(patch.rowIds[i]);
            ax[p].noalias() = patch.gram.topLeftCorner(mTerms[p], mTerms[p]) * x[p];
            ax[p] += (patch.rows.leftCols(mTerms[p]).transpose() * totals).cast<double>();
        });
    }

    const PatchVectors& right() const { return mRight; }

    template <class Do>
    void forPatches(Do&& visit) const {
        parallelFor(mTerms.size(), 16, [&](size_t begin, size_t end) {
            for (size_t p = begin; p < end; ++p)
                if (mTerms[p] > 0) visit(p);
        });
    }

  private:
    const ColorEquations& m;
    std::vector<int> mTerms;
    std::vector<Eigen::LLT<MatrixXd>> mFactors;
    PatchVectors mRight;
    std::vector<VectorXf> mPartial;  // by patch and row: its share
    VectorXf mTotals;                // by row
};

// Preconditioned conjugate gradients, until the residual is kTolerance of that of the patches by themselves.
PatchVectors conjugateGradients(ChannelSystem& system, int maxIterations, int& iterations,
                                Progress& progress) {
    constexpr double kTolerance = 1e-3;
    const size_t count = system.right().size();
    PatchVectors x(count), r(count), z(count), d(count), ad(count);
    system.precondition(system.right(), x);
    system.apply(x, ad);
    for (size_t p = 0; p < count; ++p) r[p] = system.right()[p] - ad[p];
    system.precondition(r, z);
    d = z;
    double rz = dot(r, z);
    const double enough = kTolerance * kTolerance * rz;
    for (int i = 0; i < maxIterations && rz > enough && !progress.stopRequested(); ++i, ++iterations) {
        system.apply(d, ad);
        const double alpha = rz / dot(d, ad);
        system.forPatches([&](size_t p) {
            x[p] += alpha * d[p];
            r[p] -= alpha * ad[p];
        });
        system.precondition(r, z);
        const double next = dot(r, z), beta = next / rz;
        system.forPatches([&](size_t p) { d[p] = z[p] + beta * d[p]; });
        rz = next;
    }
    return x;
}

Image inOpponentBasis(Image image) {
    float* planes[3] = {image.plane(0).data(), image.plane(1).data(), image.plane(2).data()};
    fromWorking(ColourBasis::Opponent, planes, image.planeSize());
    return image;
}

}  // namespace

Result<PatchMesh> solveColors(PatchMesh mesh, const Image& image, const Image& sharp,
                              const ColorSolveOptions& options, StageReport& report, Progress& progress) {
    const std::vector<SiteChoice> choices =
        chooseSites(mesh, inOpponentBasis(sharp), options.budget, progress);
    if (!progress.step(.3)) return stopped();
    const ColorEquations equations = buildEquations(mesh, inOpponentBasis(image), choices, options.seams,
                                                    options.samplesPerSide, progress);
    if (!progress.step(.6)) return stopped();

    std::array<PatchVectors, kMaxChannels> factors;
    int iterations = 0;
    for (int c = 0; c < mesh.channels(); ++c) {
        ChannelSystem system(equations, choices, c);
        factors[size_t(c)] = conjugateGradients(system, options.maxIterations, iterations, progress);
        if (!progress.step(.6 + .4 * (c + 1) / mesh.channels())) return stopped();
    }
    mesh.setColourBasis(ColourBasis::Opponent);
    size_t terms = 0;
    mesh.forEachPatch([&](PatchId p) {
        std::array<std::span<const double>, kMaxChannels> own;
        for (int c = 0; c < mesh.channels(); ++c) {
            const VectorXd& x = factors[size_t(c)][p.index];
            own[size_t(c)] = {x.data(), size_t(x.size())};
            terms += own[size_t(c)].size();
        }
        mesh.setSpline(p, equations.bases[p.index].spline({own.data(), size_t(mesh.channels())}));
    });
    report.figures.push_back({"terms", double(terms)});
    report.figures.push_back({"shared pixels", double(equations.pixelRows)});
    report.figures.push_back({"iterations", double(iterations)});
    return mesh;
}

}  // namespace tessera
