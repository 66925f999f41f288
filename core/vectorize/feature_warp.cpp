// See feature_warp.h.
#include "core/vectorize/feature_warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera {

namespace {

// Polylines and curves are at most a pixel or two apart, so the first lattice may be fine: far points stay
// where they are.
constexpr double kSpacings[] = {4, 2, 1};
constexpr double kInjectiveShare = .48;

// The four cubic B-splines over a cell, at s in [0, 1].
std::array<double, 4> splineWeights(double s) {
    const double r = 1 - s;
    return {r * r * r / 6, (3 * s * s * s - 6 * s * s + 4) / 6, (-3 * s * s * s + 3 * s * s + 3 * s + 1) / 6,
            s * s * s / 6};
}

// The cell of a point in a lattice, and the weights of its 4 x 4 controls.
struct Cell {
    int column, row;
    std::array<double, 4> wx, wy;
};

Cell cellOf(glm::dvec2 point, double spacing, int columns, int rows) {
    const glm::dvec2 at = point / spacing;
    const int column = std::clamp(int(std::floor(at.x)), 0, columns - 4),
              row = std::clamp(int(std::floor(at.y)), 0, rows - 4);
    return {column, row, splineWeights(std::clamp(at.x - column, 0.0, 1.0)),
            splineWeights(std::clamp(at.y - row, 0.0, 1.0))};
}

}  // namespace

glm::dvec2 FeatureWarp::Level::displacement(glm::dvec2 point) const {
    const Cell cell = cellOf(point, spacing, columns, rows);
    glm::dvec2 sum(0);
    for (size_t j = 0; j < 4; ++j)
        for (size_t i = 0; i < 4; ++i)
            sum += cell.wx[i] * cell.wy[j] *
                   glm::dvec2(
                       controls[size_t(cell.row + int(j)) * size_t(columns) + size_t(cell.column + int(i))]);
    return sum;
}

FeatureWarp::Level FeatureWarp::approximate(double width, double height, double spacing,
                                            std::span<const PointPair> pairs) {
    Level level{spacing, int(std::ceil(width / spacing)) + 3, int(std::ceil(height / spacing)) + 3, {}};
    const size_t count = size_t(level.columns) * size_t(level.rows);
    level.controls.resize(count);
    std::vector<glm::dvec2> numerator(count, glm::dvec2(0));
    std::vector<double> denominator(count, 0);
    for (const PointPair& pair : pairs) {
        const Cell cell = cellOf(pair.from, spacing, level.columns, level.rows);
        double squares = 0;
        for (size_t j = 0; j < 4; ++j)
            for (size_t i = 0; i < 4; ++i) squares += cell.wx[i] * cell.wx[i] * cell.wy[j] * cell.wy[j];
        for (size_t j = 0; j < 4; ++j)
            for (size_t i = 0; i < 4; ++i) {
                const double w = cell.wx[i] * cell.wy[j];
                const size_t k =
                    size_t(cell.row + int(j)) * size_t(level.columns) + size_t(cell.column + int(i));
                numerator[k] += w * w * (w / squares) * (pair.to - pair.from);
                denominator[k] += w * w;
            }
    }
    const double most = kInjectiveShare * spacing;
    for (size_t k = 0; k < count; ++k)
        if (denominator[k] > 0) {
            const glm::dvec2 d = numerator[k] / denominator[k];
            level.controls[k] = glm::vec2(std::clamp(d.x, -most, most), std::clamp(d.y, -most, most));
        }
    return level;
}

FeatureWarp::FeatureWarp(double width, double height, std::span<const PointPair> pairs) {
    if (pairs.empty()) return;
    std::vector<PointPair> rest(pairs.begin(), pairs.end());
    for (const double spacing : kSpacings) {
        mLevels.push_back(approximate(width, height, spacing, rest));
        for (PointPair& pair : rest) pair.from += mLevels.back().displacement(pair.from);
    }
    for (const PointPair& pair : rest) mResidual = std::max(mResidual, glm::distance(pair.from, pair.to));
}

glm::dvec2 FeatureWarp::operator()(glm::dvec2 point) const {
    for (const Level& level : mLevels) point += level.displacement(point);
    return point;
}

std::vector<PointPair> featurePairs(const PatchMesh& mesh, std::span<const std::vector<glm::dvec2>> paths) {
    std::vector<PointPair> pairs;
    mesh.forEachEdge([&](EdgeId e) {
        if (!mesh.curve(e).feature) return;
        const auto& path = paths[e.index];
        const BezierCurve curve = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
        std::vector<double> chord(path.size(), 0);
        for (size_t i = 1; i < path.size(); ++i)
            chord[i] = chord[i - 1] + glm::distance(path[i - 1], path[i]);
        // The curve's own length by a fine polyline, to invert arc length.
        constexpr int kSteps = 64;
        std::array<double, kSteps + 1> arc{};
        for (int i = 1; i <= kSteps; ++i)
            arc[size_t(i)] = arc[size_t(i - 1)] +
                             glm::distance(curve.at(double(i - 1) / kSteps), curve.at(double(i) / kSteps));
        const int count = std::max(1, int(std::ceil(chord.back())));
        for (int k = 0; k <= count; ++k) {
            const double share = double(k) / count;
            const auto piece = [share](auto begin,
                                       auto end) {  // the interval of a length table that holds the share
                const double s = share * *(end - 1);
                const auto upper = std::clamp(std::upper_bound(begin, end, s), begin + 1, end - 1);
                const double span = *upper - *(upper - 1);
                return std::pair{size_t(upper - begin) - 1, span > 0 ? (s - *(upper - 1)) / span : 0.0};
            };
            const auto [i, f] = piece(arc.begin(), arc.end());
            const auto [j, g] = piece(chord.begin(), chord.end());
            pairs.push_back({curve.at((double(i) + f) / kSteps), path[j] + g * (path[j + 1] - path[j])});
        }
    });
    return pairs;
}

}  // namespace tessera
