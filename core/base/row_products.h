// Sums of products over the rows of small dense matrices, in one order whatever the machine: what a file's
// numbers follow from, and what takes most of the time where centres are chosen.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/round_up.h"

namespace tessera {

// sums[i] += factors[j] * rows[j * stride + i] for all i < sums.size(), with j from 0 on.
void addRows(std::span<const double> factors, const double* rows, size_t stride, std::span<double> sums);

// A matrix in memory: number (i, j) is at data[i * rowStep + j * columnStep].
struct MatrixView {
    const double* data;
    size_t rowStep, columnStep;
};

// Four rows of a product: out[r * outStride + j] for r < 4 and j < columns, a multiple of 8, is the sum over
// i, from 0 on and before `length`, of left's number (i, r) times right[i * rightStride + j].
void multiplyFour(const MatrixView& left, const double* right, size_t rightStride, size_t length, double* out,
                  size_t outStride, size_t columns);

// The lower triangle, row by row with `rows` numbers each, of the matrix of sums over i, from 0 on, of
// left[k * length + i] * right[j * length + i], for j <= k. Left and right have `rows` rows; what is right of
// the diagonal is 0.
std::vector<double> lowerProducts(std::span<const double> left, std::span<const double> right, size_t rows,
                                  size_t length);

// The sums over i, from 0 on, of rows[i * stride + k] * rows[i * stride + j], for k and j < columns: a
// symmetric matrix. There are `count` rows; stride is gramStride(columns).
constexpr size_t gramStride(size_t columns) {
    constexpr size_t kStep = 16;
    return roundUp(columns, kStep);
}
std::vector<float> gram(std::span<const float> rows, size_t count, size_t columns);

}  // namespace tessera
