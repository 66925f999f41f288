// See placed_change.h.
#include "core/edit/placed_change.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {

namespace {

constexpr size_t kPlace = 3, kRows = kPlace + 3;  // a colour's differences from the mean; its place
using Rows = std::array<SitePlane, kRows>;

// Weighted sums over the sites: of products of rows, and of rows with what is left of each channel.
struct Sums {
    double products[kRows][kRows];  // the lower triangle
    double right[kRows][3];
};

TESSERA_VECTOR_CLONES
void addUp(const SitePlane& weights, const Rows& rows, const SitePlanes& rest, Sums& sums) {
    for (size_t a = 0; a < kRows; ++a) {
        SitePlane weighted;
        for (size_t i = 0; i < kSitePlane; ++i) weighted[i] = weights[i] * rows[a][i];
        for (size_t b = 0; b <= a; ++b) sums.products[a][b] = siteProduct(weighted, rows[b]);
        for (size_t c = 0; c < 3; ++c) sums.right[a][c] = siteProduct(weighted, rest[c]);
    }
}

// rest -= the sum of rows times their shares.
TESSERA_VECTOR_CLONES
void take(const Rows& rows, const float (*shares)[3], SitePlanes& rest) {
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < kSitePlane; ++i) {
            float sum = 0;
            for (size_t a = 0; a < kRows; ++a) sum += shares[a][c] * rows[a][i];
            rest[c][i] -= sum;
        }
}

// What the guess leaves of the targets, with the rows to mend it by.
TESSERA_VECTOR_CLONES
void apply(const float (*matrix)[3], const float* offset, const SitePlanes& colours,
           const SitePlanes& targets, SitePlanes& rest) {
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < size_t(kCentreSites); ++i) {
            float sum = offset[c];
            for (size_t from = 0; from < 3; ++from) sum += matrix[c][from] * colours[from][i];
            rest[c][i] = targets[c][i] - sum;
        }
}

SitePlanes leftBy(const AffineColour& change, const SitePlanes& colours, const SitePlanes& targets) {
    float matrix[3][3], offset[3];
    for (int c = 0; c < 3; ++c) {
        offset[c] = float(change.offset[c]);
        for (int from = 0; from < 3; ++from) matrix[c][from] = float(change.matrix[from][c]);
    }
    SitePlanes rest{};
    apply(matrix, offset, colours, targets, rest);
    return rest;
}

}  // namespace

PlacedChange PlacedChange::nearest(const AffineColour& guess, const SitePlanes& colours,
                                   const SitePlanes& targets, SitePlanes& rest) {
    const SitePoints& points = sitePoints();
    rest = leftBy(guess, colours, targets);
    Rows rows{};
    glm::dvec3 middle;
    for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (size_t i = 0; i < size_t(kCentreSites); ++i) sum += double(colours[c][i]);
        middle[int(c)] = sum / kCentreSites;
        for (size_t i = 0; i < size_t(kCentreSites); ++i) rows[c][i] = colours[c][i] - float(middle[int(c)]);
        rows[kPlace + c] = points.planes[c];
    }
    Sums sums;
    addUp(points.weights, rows, rest, sums);
    // Where a patch has no colours to tell from, the guess stays.
    constexpr double kRidge = 1e-4;
    Eigen::Matrix<double, kRows, kRows> normal;
    Eigen::Matrix<double, kRows, 3> right;
    for (size_t a = 0; a < kRows; ++a) {
        for (size_t b = 0; b < kRows; ++b)
            normal(Eigen::Index(a), Eigen::Index(b)) = sums.products[std::max(a, b)][std::min(a, b)];
        if (a < kPlace) normal(Eigen::Index(a), Eigen::Index(a)) += kRidge;
        for (size_t c = 0; c < 3; ++c) right(Eigen::Index(a), Eigen::Index(c)) = sums.right[a][c];
    }
    const Eigen::Matrix<double, kRows, 3> found = normal.llt().solve(right);

    PlacedChange result{guess};
    float shares[kRows][3];
    for (int c = 0; c < 3; ++c) {
        for (int a = 0; a < int(kRows); ++a) shares[a][c] = float(found(a, c));
        for (int from = 0; from < 3; ++from) result.change.matrix[from][c] += found(from, c);
        for (int corner = 0; corner < 3; ++corner)
            result.corners[size_t(c)][size_t(corner)] = shares[int(kPlace) + corner][c];
    }
    result.change.offset -= (result.change.matrix - guess.matrix) * middle;
    take(rows, shares, rest);
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < size_t(kCentreSites); ++i) {
            const double off = double(std::abs(rest[c][i]));
            result.mean += off / (3 * kCentreSites);
            result.most = std::max(result.most, off);
        }
    return result;
}

}  // namespace tessera
