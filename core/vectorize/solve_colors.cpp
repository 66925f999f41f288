// See solve_colors.h.
#include "core/vectorize/solve_colors.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/mesh/newton_basis.h"
#include "core/vectorize/patch_pixels.h"

namespace tessera {

namespace {

using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using RowMajorF = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The normal equations of one patch by itself, in the Newton basis.
struct PatchEquations {
    MatrixXd gram;
    MatrixXd moments;   // (terms x channels)
    double weight = 0;  // pixels
    std::vector<uint8_t> sites;
    int count = 0;  // of sites: the most terms of a channel
    std::array<int, kMaxChannels> terms{};
};

// Two patches along an edge that is no feature: values and derivatives across it, of both.
struct Seam {
    PatchId first, second;
    MatrixXf rowsFirst, rowsSecond;  // weighted; the difference shall be 0
};

class ColorSolver {
  public:
    ColorSolver(const PatchMesh& mesh, const Image& image, const ColorSolveOptions& options)
        : mMesh(mesh), mImage(image), mOptions(options), mEquations(mesh.connectivity().faceCapacity()) {}

    void chooseSites();
    void accumulate();
    void buildSeams();
    int solve(int channel);
    void store(PatchMesh& mesh) const;

  private:
    void pursueSites(PatchId p, const PatchPixels& pixels,
                     std::array<std::vector<float>, kMaxChannels>& errors);
    void accumulate(PatchId p, const PatchPixels& pixels);
    MatrixXf seamRows(HalfedgeId h, bool reversed, size_t samples) const;

    const PatchMesh& mMesh;
    const Image& mImage;
    const ColorSolveOptions& mOptions;
    std::vector<PatchEquations> mEquations;
    std::vector<Seam> mSeams;
    double mTerms = 0;
    std::vector<VectorXd> mSolution[kMaxChannels];
};

// Orthogonal matching pursuit: site after site, the one that takes most of the error that is left, over all
// channels. Fills the patch's sites and, by channel, the error with 3, 4, ... of them.
void ColorSolver::pursueSites(PatchId p, const PatchPixels& pixels,
                              std::array<std::vector<float>, kMaxChannels>& errors) {
    const auto count = Eigen::Index(pixels.pixels.size());
    const int channels = mMesh.channels();
    RowMajorF rows(kCentreSites, count);
    evaluateSiteFunctions(pixels.x.data(), pixels.y.data(), size_t(count), rows.data(), size_t(count));
    MatrixXf targets(count, channels);
    for (Eigen::Index k = 0; k < count; ++k)
        for (int c = 0; c < channels; ++c) targets(k, c) = mImage.plane(c)[pixels.pixels[size_t(k)].index];
    MatrixXf gram = MatrixXf::Zero(kCentreSites, kCentreSites);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(rows);
    gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
    MatrixXf rest = rows * targets;  // (sites x channels): inner products with what is left
    Eigen::VectorXf norm = gram.diagonal(), own = norm;
    Eigen::VectorXd left = targets.cast<double>().colwise().squaredNorm();
    MatrixXf taken(kCentreSites, mOptions.maxTerms);  // columns of the pivoted Cholesky factor
    std::array<bool, kCentreSites> used{};
    std::vector<uint8_t>& sites = mEquations[p.index].sites;
    const int most = std::clamp(int(mOptions.termsPerPixel * double(count)), 3, mOptions.maxTerms);
    constexpr float kDependent = 1e-4F;
    for (int k = 0; k < most; ++k) {
        int best = k < 3 ? k : -1;
        float bestGain = 0;
        for (int i = 3; i < kCentreSites && k >= 3; ++i) {
            if (used[size_t(i)] || norm(i) < kDependent * own(i)) continue;
            const float gain = rest.row(i).squaredNorm() / norm(i);
            if (gain > bestGain) {
                bestGain = gain;
                best = i;
            }
        }
        if (best < 0) break;
        used[size_t(best)] = true;
        sites.push_back(uint8_t(best));
        if (norm(best) > kDependent * own(best)) {
            auto column = taken.col(k);
            column = gram.col(best);
            column.noalias() -= taken.leftCols(k) * taken.row(best).head(k).transpose();
            column /= std::sqrt(norm(best));
            const Eigen::RowVectorXf z = rest.row(best) / std::sqrt(norm(best));
            rest.noalias() -= column * z;
            norm -= column.cwiseAbs2();
            for (int c = 0; c < channels; ++c) left(c) -= double(z(c)) * double(z(c));
        } else {
            taken.col(k).setZero();
        }
        for (int c = 0; c < channels; ++c) errors[size_t(c)].push_back(float(left(c)));
    }
}

void ColorSolver::chooseSites() {
    const size_t channels = size_t(mMesh.channels());
    std::vector<std::array<std::vector<float>, kMaxChannels>> errors(mEquations.size());
    const PixelSampler sampler(mMesh, 1);
    parallelFor(sampler.patches().size(), 4, [&](size_t begin, size_t end) {
        PatchPixels pixels;
        for (size_t i = begin; i < end; ++i) {
            sampler.sample(i, pixels);
            if (!pixels.pixels.empty())
                pursueSites(sampler.patches()[i], pixels, errors[sampler.patches()[i].index]);
        }
    });
    // As many terms as pay a price that is the same everywhere; the price is what the budget buys.
    const auto choose = [&](double price) {
        double total = 0;
        mMesh.forEachPatch([&](PatchId p) {
            for (size_t c = 0; c < channels; ++c) {
                const auto& e = errors[p.index][c];
                int best = 3;
                for (int k = 4; k <= int(e.size()); ++k)
                    if (double(e[size_t(k - 1)]) + price * k < double(e[size_t(best - 1)]) + price * best)
                        best = k;
                mEquations[p.index].terms[c] = best;
                total += best;
            }
        });
        return total;
    };
    const double budget = mOptions.termsPerPatch * double(mMesh.patchCount());
    double low = 1e-9, high = 10;
    for (int i = 0; i < 40; ++i) {
        const double middle = std::sqrt(low * high);
        (choose(middle) > budget ? low : high) = middle;
    }
    mTerms = choose(high);
    {
        double e = 0;
        mMesh.forEachPatch([&](PatchId p) {
            for (size_t c = 0; c < channels; c++)
                if (!errors[p.index][c].empty())
                    e += errors[p.index][c][size_t(
                        std::min<int>(mEquations[p.index].terms[c], int(errors[p.index][c].size())) - 1)];
        });
        printf("predicted %.2f\n", 10 * std::log10(double(mImage.planeSize()) * 3 / e));
    }
    mMesh.forEachPatch([&](PatchId p) {
        PatchEquations& eq = mEquations[p.index];
        eq.count = *std::max_element(eq.terms.begin(), eq.terms.end());
        if (eq.sites.empty()) eq.sites = {0, 1, 2};
        eq.sites.resize(size_t(eq.count));
    });
}

void ColorSolver::accumulate(PatchId p, const PatchPixels& pixels) {
    PatchEquations& eq = mEquations[p.index];
    const NewtonBasis basis(eq.sites);
    const int n = eq.count;
    const size_t samples = pixels.x.size();
    // Means over each pixel's samples.
    RowMajorF values(n, Eigen::Index(samples));
    basis.evaluate(pixels.x.data(), pixels.y.data(), samples, values.data(), samples);
    MatrixXf rows = MatrixXf::Zero(n, Eigen::Index(pixels.pixels.size()));
    const float share = 1 / float(mOptions.samplesPerSide * mOptions.samplesPerSide);
    for (size_t i = 0; i < samples; ++i) rows.col(pixels.pixelOf[i]) += values.col(Eigen::Index(i));
    MatrixXf targets(Eigen::Index(pixels.pixels.size()), mMesh.channels());
    for (size_t k = 0; k < pixels.pixels.size(); ++k) {
        // sqrt(coverage) times the mean over the part that lies in the patch
        const float coverage = pixels.pixels[k].coverage, root = std::sqrt(coverage);
        rows.col(Eigen::Index(k)) *= share / coverage * root;
        for (int c = 0; c < mMesh.channels(); ++c)
            targets(Eigen::Index(k), c) = root * mImage.plane(c)[pixels.pixels[k].index];
        eq.weight += double(coverage);
    }
    MatrixXf gram = MatrixXf::Zero(n, n);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(rows);
    gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
    eq.gram = gram.cast<double>();
    eq.gram.diagonal().array() += mOptions.ridge * std::max(1.0, eq.weight);
    eq.moments = (rows * targets).cast<double>();
}

void ColorSolver::accumulate() {
    const PixelSampler sampler(mMesh, mOptions.samplesPerSide);
    mMesh.forEachPatch([&](PatchId p) {
        PatchEquations& eq = mEquations[p.index];
        eq.gram = MatrixXd::Identity(eq.count, eq.count);
        eq.moments = MatrixXd::Zero(eq.count, mMesh.channels());
    });
    parallelFor(sampler.patches().size(), 4, [&](size_t begin, size_t end) {
        PatchPixels pixels;
        for (size_t i = begin; i < end; ++i) {
            sampler.sample(i, pixels);
            if (!pixels.pixels.empty()) accumulate(sampler.patches()[i], pixels);
        }
    });
}

MatrixXf ColorSolver::seamRows(HalfedgeId h, bool reversed, size_t samples) const {
    const HalfedgeMesh& mesh = mMesh.connectivity();
    const PatchId p = mesh.face(h);
    const auto sides = mesh.sides(p);
    const size_t side = size_t(std::find(sides.begin(), sides.end(), h) - sides.begin());
    const BezierTriangle t = toPixels(mMesh.controlPoints(p));
    const int n = mEquations[p.index].count;
    const NewtonBasis basis(mEquations[p.index].sites);
    const BezierCurve curve = toPixels(mMesh.controlPoints(HalfedgeMesh::halfedge(HalfedgeMesh::edge(h))));
    const double spacing = curve.length() / double(samples);
    const double w0 = std::sqrt(mOptions.weightC0 * spacing), w1 = std::sqrt(mOptions.weightC1 * spacing);
    MatrixXf rows(Eigen::Index(2 * samples), n);
    const auto size = size_t(n);
    std::vector<double> value(size), dx(size), dy(size);
    for (size_t i = 0; i < samples; ++i) {
        const double along = (double(i) + .5) / double(samples), s = reversed ? 1 - along : along;
        Barycentric b(0);
        b[int(side)] = 1 - s;
        b[int((side + 1) % 3)] = s;
        basis.evaluateWithDerivatives(domainPoint(b), value.data(), dx.data(), dy.data());
        // Domain derivatives to image derivatives: d(x, y) = J d(v, w), domain = (v + w / 2, h w).
        const PatchPoint at = evaluateWithDerivatives(t, b);
        const double det = cross(at.dv, at.dw);
        glm::dvec2 tangent = curve.derivative(along);
        tangent /= std::max(1e-9, std::sqrt(tangent.x * tangent.x + tangent.y * tangent.y));
        const glm::dvec2 normal(-tangent.y, tangent.x);
        // The step in (v, w) that goes along the normal.
        const double dv = det > 1e-9 ? cross(normal, at.dw) / det : 0,
                     dw = det > 1e-9 ? cross(at.dv, normal) / det : 0;
        const double stepX = dv + .5 * dw, stepY = kDomainHeight * dw;
        for (int k = 0; k < n; ++k) {
            rows(Eigen::Index(2 * i), k) = float(w0 * value[size_t(k)]);
            rows(Eigen::Index(2 * i + 1), k) = float(w1 * (dx[size_t(k)] * stepX + dy[size_t(k)] * stepY));
        }
    }
    return rows;
}

void ColorSolver::buildSeams() {
    mMesh.forEachEdge([&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        const HalfedgeMesh& mesh = mMesh.connectivity();
        if (mesh.onBorder(e) || mMesh.curve(e).feature) return;
        mSeams.push_back({mesh.face(h), mesh.face(HalfedgeMesh::twin(h)), {}, {}});
        mSeams.back().rowsFirst.resize(1, 1);
        mSeams.back().rowsFirst(0, 0) = float(e.index);
    });
    parallelFor(mSeams.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Seam& s = mSeams[i];
            const EdgeId e(uint32_t(s.rowsFirst(0, 0)));
            const HalfedgeId h = HalfedgeMesh::halfedge(e);
            const double length = toPixels(mMesh.controlPoints(h)).length();
            const size_t samples = size_t(std::clamp(int(length * .7), 4, 16));
            s.rowsFirst = seamRows(h, false, samples);
            s.rowsSecond = seamRows(HalfedgeMesh::twin(h), true, samples);
        }
    });
}

// Conjugate gradients with the blocks of single patches as preconditioner.
int ColorSolver::solve(int channel) {
    const size_t c = size_t(channel), count = mEquations.size();
    std::vector<int> n(count);
    std::vector<MatrixXd> diagonal(count);
    std::vector<VectorXd> b(count);
    for (size_t p = 0; p < count; ++p) {
        n[p] = mEquations[p].terms[c];
        if (n[p] == 0) continue;
        diagonal[p] = mEquations[p].gram.topLeftCorner(n[p], n[p]);
        b[p] = mEquations[p].moments.col(channel).head(n[p]);
    }
    // Each pair's coupling, and by patch the pairs that it is in.
    std::vector<MatrixXd> coupling(mSeams.size());
    std::vector<std::vector<std::pair<uint32_t, bool>>> pairsOf(count);
    for (size_t i = 0; i < mSeams.size(); ++i) {
        pairsOf[mSeams[i].first.index].push_back({uint32_t(i), true});
        pairsOf[mSeams[i].second.index].push_back({uint32_t(i), false});
    }
    parallelFor(mSeams.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Seam& s = mSeams[i];
            coupling[i] = (-(s.rowsFirst.leftCols(n[s.first.index]).transpose() *
                             s.rowsSecond.leftCols(n[s.second.index])))
                              .cast<double>();
        }
    });
    std::vector<Eigen::LLT<MatrixXd>> factor(count);
    std::vector<VectorXd>& x = mSolution[c];
    x.assign(count, {});
    parallelFor(count, 8, [&](size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) {
            if (n[p] == 0) continue;
            x[p] = diagonal[p].llt().solve(b[p]);
            for (const auto& [i, first] : pairsOf[p]) {
                const MatrixXf& rows = first ? mSeams[i].rowsFirst : mSeams[i].rowsSecond;
                diagonal[p] += (rows.leftCols(n[p]).transpose() * rows.leftCols(n[p])).cast<double>();
            }
            factor[p].compute(diagonal[p]);
        }
    });
    const auto apply = [&](const std::vector<VectorXd>& v, std::vector<VectorXd>& out) {
        parallelFor(count, 16, [&](size_t begin, size_t end) {
            for (size_t p = begin; p < end; ++p) {
                if (n[p] == 0) continue;
                out[p].noalias() = diagonal[p] * v[p];
                for (const auto& [i, first] : pairsOf[p]) {
                    if (first)
                        out[p].noalias() += coupling[i] * v[mSeams[i].second.index];
                    else
                        out[p].noalias() += coupling[i].transpose() * v[mSeams[i].first.index];
                }
            }
        });
    };
    std::vector<double> partial(count);
    const auto dot = [&](const std::vector<VectorXd>& u, const std::vector<VectorXd>& v) {
        double sum = 0;
        for (size_t p = 0; p < count; ++p)
            if (n[p] > 0) sum += u[p].dot(v[p]);
        return sum;
    };
    std::vector<VectorXd> r(count), z(count), d(count), ad(count);
    apply(x, ad);
    double norm = 0;
    for (size_t p = 0; p < count; ++p) {
        if (n[p] == 0) continue;
        r[p] = b[p] - ad[p];
        z[p] = factor[p].solve(r[p]);
        d[p] = z[p];
    }
    double rz = dot(r, z);
    norm = rz;
    int iteration = 0;
    for (; iteration < mOptions.maxIterations && rz > 1e-6 * norm; ++iteration) {
        apply(d, ad);
        const double alpha = rz / dot(d, ad);
        parallelFor(count, 32, [&](size_t begin, size_t end) {
            for (size_t p = begin; p < end; ++p) {
                if (n[p] == 0) continue;
                x[p] += alpha * d[p];
                r[p] -= alpha * ad[p];
                z[p] = factor[p].solve(r[p]);
            }
        });
        const double next = dot(r, z), beta = next / rz;
        rz = next;
        for (size_t p = 0; p < count; ++p)
            if (n[p] > 0) d[p] = z[p] + beta * d[p];
    }
    return iteration;
}

void ColorSolver::store(PatchMesh& mesh) const {
    mesh.forEachPatch([&](PatchId p) {
        std::array<std::span<const double>, kMaxChannels> factors;
        for (int c = 0; c < mMesh.channels(); ++c) {
            const VectorXd& x = mSolution[size_t(c)][p.index];
            factors[size_t(c)] = {x.data(), size_t(x.size())};
        }
        mesh.setSpline(
            p, NewtonBasis(mEquations[p.index].sites).spline({factors.data(), size_t(mMesh.channels())}));
    });
}

}  // namespace

Result<PatchMesh> solveColors(PatchMesh mesh, const Image& image, const ColorSolveOptions& options,
                              StageReport& report, Progress& progress) {
    Image opponent = image;
    float* planes[3] = {opponent.plane(0).data(), opponent.plane(1).data(), opponent.plane(2).data()};
    fromWorking(ColourBasis::Opponent, planes, opponent.planeSize());
    ColorSolver solver(mesh, opponent, options);
    solver.chooseSites();
    if (!progress.step(.4)) return stopped();
    solver.accumulate();
    solver.buildSeams();
    int iterations = 0;
    for (int c = 0; c < mesh.channels(); ++c) iterations += solver.solve(c);
    report.figures.push_back({"iterations", double(iterations)});
    mesh.setColourBasis(ColourBasis::Opponent);
    solver.store(mesh);
    return mesh;
}

}  // namespace tessera
