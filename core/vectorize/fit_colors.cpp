// See fit_colors.h.
#include "core/vectorize/fit_colors.h"

#include <Eigen/Dense>
#include <atomic>

#include "core/base/parallel.h"
#include "core/vectorize/feature_warp.h"

namespace tessera {

namespace {

constexpr int kCoefficients = kDefaultCentreCount + 3;

// The least-squares solution of Eq. (5) for one set of constraint points: coefficients = solve * colours.
struct ConstraintSystem {
    std::vector<Barycentric> points;
    Eigen::MatrixXd solve;  // kCoefficients x points
};

ConstraintSystem makeSystem(int n, unsigned pairedSides) {
    ConstraintSystem system{constraintPoints(n, pairedSides), {}};
    const auto rows = Eigen::Index(system.points.size());
    Eigen::MatrixXd a(rows, kCoefficients);
    for (Eigen::Index r = 0; r < rows; ++r) {
        const glm::dvec2 at = domainPoint(system.points[size_t(r)]);
        a(r, 0) = 1;
        a(r, 1) = at.x;
        a(r, 2) = at.y;
        for (int i = 0; i < kDefaultCentreCount; ++i) {
            const glm::dvec2 d = at - defaultCentres()[size_t(i)];
            a(r, 3 + i) = tpsKernel(d.x * d.x + d.y * d.y);
        }
    }
    // Coefficients that fulfil the side conditions are exactly those that interpolate some values at the
    // centres: the columns of the nodal basis span the null space of the conditions.
    const NodalBasis& nodal = defaultNodalBasis();
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> basis(
        nodal.toCoefficients.data(), kCoefficients, kDefaultCentreCount);
    const Eigen::MatrixXd reduced = a * basis;
    const Eigen::MatrixXd inverse =
        reduced.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(rows, rows));
    system.solve = basis * inverse;
    return system;
}

unsigned pairedSides(const PatchMesh& mesh, PatchId p) {
    unsigned paired = 0;
    const auto sides = mesh.connectivity().sides(p);
    for (unsigned s = 0; s < 3; ++s) {
        const EdgeId e = HalfedgeMesh::edge(sides[s]);
        if (!mesh.curve(e).feature && !mesh.connectivity().onBorder(e)) paired |= 1U << s;
    }
    return paired;
}

}  // namespace

std::vector<Barycentric> constraintPoints(int n, unsigned pairedSides) {
    std::vector<Barycentric> points;
    const auto at = [n](double i, double j) { return Barycentric(i / n, j / n, (n - i - j) / n); };
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) points.push_back(at(i, j));
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
            points.push_back(at(i + 1.0 / 3, j + 1.0 / 3));
            if (i + j + 1 < n) points.push_back(at(i + 2.0 / 3, j + 2.0 / 3));
        }
    for (int s = 0; s < 3; ++s) {
        if (!(pairedSides & (1U << s))) continue;
        for (int k = 1; k < n; ++k)
            for (const double inward : {kPairOffset / n, -kPairOffset / n}) {
                // Side s joins corners s and s + 1; moving in along the normal shares the gain between them.
                const double t = double(k) / n;
                Barycentric b;
                b[s] = 1 - t - .5 * inward;
                b[(s + 1) % 3] = t - .5 * inward;
                b[(s + 2) % 3] = inward;
                points.push_back(b);
            }
    }
    return points;
}

Result<PatchMesh> fitColors(PatchMesh mesh, std::span<const std::vector<glm::dvec2>> paths,
                            const Image& image, const VectorizeSettings& settings, StageReport& report,
                            Progress& progress) {
    const bool warped = report.variant != "sampled-nowarp";
    const FeatureWarp warp(image.width(), image.height(),
                           warped ? featurePairs(mesh, paths) : std::vector<PointPair>{});
    if (!progress.step(.1)) return stopped();
    std::vector<ConstraintSystem> systems;  // by set of paired sides
    for (unsigned paired = 0; paired < 8; ++paired) {
        systems.push_back(makeSystem(settings.samplesPerSide, paired));
        if (!progress.step(.1 + .01 * paired)) return stopped();
    }

    std::vector<PatchId> patches;
    mesh.forEachPatch([&](PatchId p) { patches.push_back(p); });
    std::vector<PatchSpline> splines(patches.size());
    std::atomic<size_t> done{0};
    std::atomic<bool> stop{false};
    parallelFor(patches.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end && !stop; ++i) {
            const ConstraintSystem& system = systems[pairedSides(mesh, patches[i])];
            const BezierTriangle patch = toPixels(mesh.controlPoints(patches[i]));
            Eigen::MatrixXd colours(Eigen::Index(system.points.size()), image.channels());
            for (size_t k = 0; k < system.points.size(); ++k) {
                const glm::dvec2 at = warp(evaluate(patch, system.points[k]));
                for (int c = 0; c < image.channels(); ++c)
                    colours(Eigen::Index(k), c) = double(bilinear(image, c, at.x, at.y));
            }
            const Eigen::MatrixXd solution = system.solve * colours;
            for (int c = 0; c < image.channels(); ++c) {
                splines[i].terms[size_t(c)] = kDefaultCentreCount;
                for (int k = 0; k < kCoefficients; ++k)
                    splines[i].coefficients.push_back(float(solution(k, c)));
            }
        }
        done += end - begin;
        if (!progress.step(.2 + .8 * double(done) / double(patches.size()))) stop = true;
    });
    if (stop) return stopped();
    for (size_t i = 0; i < patches.size(); ++i) mesh.setSpline(patches[i], std::move(splines[i]));
    report.figures = {{"coefficients", double(patches.size()) * kCoefficients * image.channels()},
                      {"warp residual px", warp.residual()}};
    return mesh;
}

}  // namespace tessera
