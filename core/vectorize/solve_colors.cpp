// See solve_colors.h.
#include "core/vectorize/solve_colors.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/parallel.h"
#include "core/base/row_products.h"
#include "core/mesh/colour_basis.h"
#include "core/mesh/newton_basis.h"
#include "core/vectorize/color_equations.h"

namespace tessera {

namespace {

using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using Eigen::VectorXf;

// A whole pixel is sampled at 2 x 2 points or more, as the renderer does at x1.
int samplesPerSide(const FitGrid& grid) {
    constexpr int kSamplesPerSide = 2;
    return std::max(1, kSamplesPerSide / grid.perSide);
}

// Of the residual of the patches by themselves: to find the weight, and in the end.
constexpr double kFirstTolerance = 1.5e-3, kTolerance = 5e-4;
constexpr double kLeastSeamWeight = .05, kMostSeamWeight = 50;

// By patch id; empty where there is no patch.
using PatchVectors = std::vector<VectorXd>;

double dot(const PatchVectors& a, const PatchVectors& b) {
    double sum = 0;
    for (size_t p = 0; p < a.size(); ++p)
        if (a[p].size() > 0) sum += a[p].dot(b[p]);
    return sum;
}

// Row after row in columns of the result, which has gramStride rows.
MatrixXf unpackedRows(const ColorEquations::Patch& patch) {
    const auto count = size_t(patch.count);
    MatrixXf rows = MatrixXf::Zero(Eigen::Index(gramStride(count)), Eigen::Index(patch.rows.size()));
    for (size_t i = 0; i < patch.rows.size(); ++i)
        patch.rows.addTo(i, {rows.col(Eigen::Index(i)).data(), count});
    return rows;
}
Eigen::Map<const MatrixXf> gramOf(const ColorEquations::Patch& patch) {
    return {patch.gram.data(), patch.count, patch.count};
}
std::span<const float> spanOf(const VectorXf& v) {
    return {v.data(), size_t(v.size())};
}
Eigen::Map<const VectorXd> dampingOf(const ColorEquations::Patch& patch) {
    return {patch.damping.data(), patch.count};
}

// Each patch by itself, others' shares in common rows left out, by Cholesky. Channels have a patch's first
// terms, and the factor of a matrix's first rows and columns is a part of its factor: one serves them all.
class Preconditioner {
  public:
    // `weights` of the rows' squares. Incomplete where progress says stop.
    Preconditioner(const ColorEquations& equations, const VectorXf& weights, const ProgressPart& progress)
        : mFactors(equations.patches.size()) {
        parallelFor(mFactors.size(), 8, [&](size_t begin, size_t end) {
            for (size_t p = begin; p < end && !progress.stopRequested(); ++p) {
                const auto& patch = equations.patches[p];
                if (patch.count == 0) continue;
                const auto count = size_t(patch.count);
                VectorXf rootWeights(Eigen::Index(patch.rowIds.size()));
                for (size_t i = 0; i < patch.rowIds.size(); ++i)
                    rootWeights(Eigen::Index(i)) = std::sqrt(weights(patch.rowIds[i]));
                MatrixXf rows = unpackedRows(patch);
                rows *= rootWeights.asDiagonal();
                const std::vector<float> own =
                    gram({rows.data(), size_t(rows.size())}, patch.rows.size(), count);
                MatrixXd normal =
                    gramOf(patch).cast<double>() +
                    Eigen::Map<const MatrixXf>(own.data(), patch.count, patch.count).cast<double>();
                normal.diagonal() += dampingOf(patch);
                mFactors[p] = normal.llt().matrixLLT().cast<float>();
            }
        });
    }

    // Of the patch's first r.size() terms.
    VectorXd solve(size_t p, const VectorXd& r) const {
        VectorXf solved = r.cast<float>();
        const auto first = mFactors[p].topLeftCorner(r.size(), r.size());
        const auto lower = first.triangularView<Eigen::Lower>();
        lower.solveInPlace(solved);
        lower.transpose().solveInPlace(solved);
        return solved.cast<double>();
    }

  private:
    std::vector<MatrixXf> mFactors;  // lower triangles, rounded
};

// The normal equations of one channel, A x = b, with patches' first terms alone.
class ChannelSystem {
  public:
    // `weights` of the rows' squares. Keeps references to all but the choices.
    ChannelSystem(const ColorEquations& equations, const std::vector<SiteChoice>& choices,
                  const VectorXf& weights, int channel)
        : m(equations),
          mWeights(weights),
          mChannel(channel),
          mTerms(equations.patches.size(), 0),
          mPartial(equations.patches.size()),
          mSums(Eigen::Index(equations.rowCount)) {
        for (size_t p = 0; p < m.patches.size(); ++p)
            if (m.patches[p].count > 0) mTerms[p] = choices[p].terms[size_t(channel)];
    }

    // b.
    PatchVectors right() const {
        PatchVectors right(m.patches.size());
        const float* wanted = &m.targets[size_t(mChannel) * m.rowCount];
        forPatches([&](size_t p) {
            const auto& patch = m.patches[p];
            right[p] = Eigen::Map<const VectorXd>(patch.moments.data() + mChannel * patch.count, mTerms[p]) +
                       timesRows(p, [&](uint32_t row) { return mWeights(row) * wanted[row]; }).cast<double>();
        });
        return right;
    }

    // A x.
    void apply(const PatchVectors& x, PatchVectors& ax) {
        sumRows(x);
        forPatches([&](size_t p) {
            const auto& patch = m.patches[p];
            const int n = mTerms[p];
            VectorXf sum = timesRows(p, [&](uint32_t row) { return mWeights(row) * mSums(row); });
            sum.noalias() += gramOf(patch).topLeftCorner(n, n) * x[p].cast<float>();
            ax[p] = dampingOf(patch).head(n).cwiseProduct(x[p]) + sum.cast<double>();
        });
    }

    // What each row comes to at x, before its weight.
    const VectorXf& sumRows(const PatchVectors& x) {
        forPatches([&](size_t p) {
            const auto& patch = m.patches[p];
            const VectorXf rounded = x[p].cast<float>();
            mPartial[p].resize(Eigen::Index(patch.rows.size()));
            patch.rows.multiply(spanOf(rounded), {mPartial[p].data(), patch.rows.size()});
        });
        parallelFor(size_t(mSums.size()), 4096, [&](size_t begin, size_t end) {
            for (size_t row = begin; row < end; ++row) {
                float sum = 0;
                for (uint32_t i = m.firstEntry[row]; i < m.firstEntry[row + 1]; ++i)
                    sum += mPartial[m.entries[i].patch](m.entries[i].place);
                mSums(Eigen::Index(row)) = sum;
            }
        });
        return mSums;
    }

    template <class Do>
    void forPatches(Do&& visit) const {
        parallelFor(mTerms.size(), 16, [&](size_t begin, size_t end) {
            for (size_t p = begin; p < end; ++p)
                if (mTerms[p] > 0) visit(p);
        });
    }

  private:
    // The sum of a patch's rows times what `factor` says of them.
    template <class Factor>
    VectorXf timesRows(size_t p, Factor&& factor) const {
        const auto& patch = m.patches[p];
        VectorXf factors(Eigen::Index(patch.rowIds.size())), sum(mTerms[p]);
        for (size_t i = 0; i < patch.rowIds.size(); ++i) factors(Eigen::Index(i)) = factor(patch.rowIds[i]);
        patch.rows.multiplyTransposed(spanOf(factors), {sum.data(), size_t(sum.size())});
        return sum;
    }

    const ColorEquations& m;
    const VectorXf& mWeights;
    int mChannel;
    std::vector<int> mTerms;
    std::vector<VectorXf> mPartial;  // by patch and row: its share
    VectorXf mSums;                  // by row
};

// Preconditioned conjugate gradients from x (or nothing), until the residual is `tolerance` of that of the
// patches by themselves.
PatchVectors conjugateGradients(ChannelSystem& system, const Preconditioner& preconditioner, PatchVectors x,
                                double tolerance, int& iterations, const ProgressPart& progress) {
    constexpr int kMaxIterations = 60;
    const auto precondition = [&](const PatchVectors& r, PatchVectors& z) {
        system.forPatches([&](size_t p) { z[p] = preconditioner.solve(p, r[p]); });
    };
    PatchVectors r = system.right();
    const size_t count = r.size();
    PatchVectors alone(count), z(count), d(count), ad(count);
    precondition(r, alone);
    const double enough = tolerance * tolerance * dot(r, alone);
    if (x.empty()) x = std::move(alone);
    system.apply(x, ad);
    system.forPatches([&](size_t p) { r[p] -= ad[p]; });
    precondition(r, z);
    d = z;
    double rz = dot(r, z);
    const double first = std::log(rz / enough);
    for (int i = 0; i < kMaxIterations && rz > enough; ++i, ++iterations) {
        if (!progress.step(1 - std::log(rz / enough) / first)) break;
        system.apply(d, ad);
        const double alpha = rz / dot(d, ad);
        system.forPatches([&](size_t p) {
            x[p] += alpha * d[p];
            r[p] -= alpha * ad[p];
        });
        precondition(r, z);
        const double next = dot(r, z), beta = next / rz;
        system.forPatches([&](size_t p) { d[p] = z[p] + beta * d[p]; });
        rz = next;
    }
    return x;
}

// Each channel's factors from those given (or none). False where progress says stop.
bool solveChannels(const ColorEquations& equations, const std::vector<SiteChoice>& choices,
                   const VectorXf& weights, double tolerance, std::span<PatchVectors> factors,
                   int& iterations, const ProgressPart& progress) {
    const Preconditioner preconditioner(equations, weights, progress);
    const double channels = double(factors.size());
    for (size_t c = 0; c < factors.size() && !progress.stopRequested(); ++c) {
        ChannelSystem system(equations, choices, weights, int(c));
        factors[c] = conjugateGradients(system, preconditioner, std::move(factors[c]), tolerance, iterations,
                                        progress.part(double(c) / channels, double(c + 1) / channels));
    }
    return progress.step(1);
}

// How far the two sides of seams are apart: the mean of |difference| over the channels of the working space,
// weighted by length, over what it may be; or the 95th percentile, if that is worse.
double seamExcess(const ColorEquations& equations, const std::vector<SiteChoice>& choices,
                  const std::array<PatchVectors, kMaxChannels>& factors, int channels,
                  const VectorXf& weights, const VectorizeSettings& settings) {
    std::array<std::vector<float>, kMaxChannels> differences;
    std::vector<double> lengths;
    for (int c = 0; c < channels; ++c) {
        ChannelSystem system(equations, choices, weights, c);
        const VectorXf& sums = system.sumRows(factors[size_t(c)]);
        for (const ColorEquations::Seam& seam : equations.seams)
            for (uint32_t i = 0; i < seam.points; ++i)
                differences[size_t(c)].push_back(
                    float(double(sums(seam.firstRow + i)) / std::sqrt(seam.weight * seam.length(i))));
    }
    for (const ColorEquations::Seam& seam : equations.seams)
        for (uint32_t i = 0; i < seam.points; ++i) lengths.push_back(seam.length(i));
    float* planes[3] = {differences[0].data(), differences[1].data(), differences[2].data()};
    toWorking(ColourBasis::Opponent, planes, lengths.size());

    std::vector<std::pair<float, double>> levels;  // and the length that has them
    double sum = 0, length = 0;
    for (size_t i = 0; i < lengths.size(); ++i) {
        double level = 0;
        for (int c = 0; c < channels; ++c)
            level += std::abs(double(differences[size_t(c)][i])) * 255 / channels;
        levels.emplace_back(float(level), lengths[i]);
        sum += level * lengths[i];
        length += lengths[i];
    }
    if (length <= 0) return 0;
    std::sort(levels.begin(), levels.end());
    double above = .05 * length;
    size_t i = levels.size();
    while (i > 1 && above > 0) above -= levels[--i].second;
    return std::max(sum / length / settings.seamMeanLevels,
                    double(levels[i].first) / settings.seamHighLevels);
}

// Finds the weight at which the excess is 1, by secants: seams go with a power of their weight, about the
// cube root at first.
class SeamWeightSearch {
  public:
    double next(double weight, double excess) {
        const double w = std::log(weight), e = std::log(std::max(excess, 1e-3));
        if (mKnown && std::abs(w - mLastWeight) > 1e-3)
            mSlope = std::clamp((e - mLastExcess) / (w - mLastWeight), kSteepest, kFlattest);
        mKnown = true;
        mLastWeight = w;
        mLastExcess = e;
        return std::clamp(std::exp(w - e / mSlope), kLeastSeamWeight, kMostSeamWeight);
    }

  private:
    static constexpr double kSteepest = -.6, kFlattest = -.2;
    double mSlope = -1.0 / 3, mLastWeight = 0, mLastExcess = 0;
    bool mKnown = false;
};

// Gives patches that are not held the splines of their factors; how many terms these have. Bases are made
// again: to keep them all from the equations on would take more memory than anything else.
size_t setSplines(PatchMesh& mesh, const ColorEquations& equations, const std::vector<SiteChoice>& choices,
                  const std::array<PatchVectors, kMaxChannels>& factors) {
    std::vector<PatchSpline> splines(equations.patches.size());
    parallelFor(splines.size(), 16, [&](size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) {
            if (equations.patches[p].count == 0) continue;
            std::array<std::span<const double>, kMaxChannels> own;
            for (size_t c = 0; c < size_t(mesh.channels()); ++c)
                own[c] = {factors[c][p].data(), size_t(factors[c][p].size())};
            splines[p] = NewtonBasis(choices[p].sites).spline({own.data(), size_t(mesh.channels())});
        }
    });
    size_t terms = 0;
    mesh.forEachPatch([&](PatchId p) {
        if (equations.patches[p.index].count == 0) return;
        for (int c = 0; c < mesh.channels(); ++c) terms += size_t(factors[size_t(c)][p.index].size());
        mesh.setSpline(p, std::move(splines[p.index]));
    });
    return terms;
}

}  // namespace

Image inBasis(Image picture, ColourBasis basis) {
    float* planes[3] = {picture.plane(0).data(), picture.plane(1).data(), picture.plane(2).data()};
    fromWorking(basis, planes, picture.planeSize());
    return picture;
}

Result<PatchMesh> solveColors(PatchMesh mesh, FitPicture picture, const std::vector<SiteChoice>& choices,
                              const VectorizeSettings& settings, StageReport& report,
                              const ProgressPart& progress) {
    const SeamWeights seams{1, settings.seamGradientWeight};
    const ColorEquations equations =
        buildEquations(mesh, picture, choices, seams, samplesPerSide(picture.grid), progress.part(0, .5));
    if (!progress.step(.5)) return stopped();
    picture = FitPicture(Image());  // a good part of the memory, with large pictures

    std::array<PatchVectors, kMaxChannels> factors;
    VectorXf weights = VectorXf::Ones(Eigen::Index(equations.rowCount));
    int iterations = 0;
    double seamWeight = 1;
    SeamWeightSearch search;
    const int passes = settings.seamPasses;
    for (int pass = 0; pass < passes; ++pass) {
        const bool last = pass + 1 == passes;
        const ProgressPart part =
            progress.part(.5 + .5 * pass / double(passes), .5 + .5 * (pass + 1) / double(passes));
        if (!solveChannels(equations, choices, weights, last ? kTolerance : kFirstTolerance,
                           {factors.data(), size_t(mesh.channels())}, iterations, part))
            return stopped();
        if (last) break;
        seamWeight = search.next(seamWeight,
                                 seamExcess(equations, choices, factors, mesh.channels(), weights, settings));
        weights.tail(weights.size() - equations.cellRows).setConstant(float(seamWeight));
    }
    report.figures.push_back({"seam weight", seamWeight});
    mesh.setColourBasis(ColourBasis::Opponent);
    const size_t terms = setSplines(mesh, equations, choices, factors);
    report.figures.push_back({"terms", double(terms)});
    report.figures.push_back({"shared cells", double(equations.cellRows)});
    report.figures.push_back({"iterations", double(iterations)});
    return mesh;
}

Result<std::vector<PatchId>> refitColors(PatchMesh& mesh, const FitPicture& picture,
                                         const std::vector<SiteChoice>& choices, double seamGradientWeight,
                                         double seamWeight, const ProgressPart& progress) {
    const ColorEquations equations = buildEquations(mesh, picture, choices, {1, seamGradientWeight},
                                                    samplesPerSide(picture.grid), progress.part(0, .5));
    if (!progress.step(.5)) return stopped();
    VectorXf weights = VectorXf::Ones(Eigen::Index(equations.rowCount));
    weights.tail(weights.size() - equations.cellRows).setConstant(float(seamWeight));
    std::array<PatchVectors, kMaxChannels> factors;
    int iterations = 0;
    if (!solveChannels(equations, choices, weights, kTolerance, {factors.data(), size_t(mesh.channels())},
                       iterations, progress.part(.5, 1)))
        return stopped();
    setSplines(mesh, equations, choices, factors);
    std::vector<PatchId> solved;
    for (uint32_t p = 0; p < equations.patches.size(); ++p)
        if (equations.patches[p].count > 0) solved.push_back(PatchId(p));
    return solved;
}

}  // namespace tessera
