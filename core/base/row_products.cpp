// See row_products.h.
#include "core/base/row_products.h"

#include <algorithm>
#include <array>

#include "core/base/check.h"
#include "core/base/round_up.h"
#include "core/base/vectors.h"

namespace tessera {

namespace {

// A tile of a product is four rows of two vectors.
constexpr size_t kTileRows = 4, kVectorBytes = 32;
template <class T>
constexpr size_t kTileColumns = 2 * kVectorBytes / sizeof(T);

template <class T>
using Lanes = VectorInMemory<T, kVectorBytes / sizeof(T)>;

TESSERA_VECTOR_CLONES
void addRowsTo(const double* factors, size_t count, const double* rows, size_t stride,
               double* __restrict sums, size_t length) {
    size_t j = 0;
    for (; j + 4 <= count; j += 4) {
        const double *f = factors + j, *a = rows + j * stride, *b = a + stride, *c = b + stride,
                     *d = c + stride;
        const double f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3];
        for (size_t i = 0; i < length; ++i)
            sums[i] = (((sums[i] + f0 * a[i]) + f1 * b[i]) + f2 * c[i]) + f3 * d[i];
    }
    for (; j < count; ++j) {
        const double f = factors[j], *row = rows + j * stride;
        for (size_t i = 0; i < length; ++i) sums[i] += f * row[i];
    }
}

// One tile: the sums over i of left[i * leftRow + r * leftColumn] * right[i * rightRow + j].
template <class T>
TESSERA_INLINE void multiplyTile(const T* left, size_t leftRow, size_t leftColumn, const T* right,
                                 size_t rightRow, size_t length, T* out, size_t outRow) {
    Lanes<T> a0{}, a1{}, b0{}, b1{}, c0{}, c1{}, d0{}, d1{};
    for (size_t i = 0; i < length; ++i, left += leftRow, right += rightRow) {
        const Lanes<T>* lanes = reinterpret_cast<const Lanes<T>*>(right);
        const Lanes<T> x = lanes[0], y = lanes[1];
        const T a = left[0], b = left[leftColumn], c = left[2 * leftColumn], d = left[3 * leftColumn];
        a0 += a * x;
        a1 += a * y;
        b0 += b * x;
        b1 += b * y;
        c0 += c * x;
        c1 += c * y;
        d0 += d * x;
        d1 += d * y;
    }
    Lanes<T>* to = reinterpret_cast<Lanes<T>*>(out);
    to[0] = a0;
    to[1] = a1;
    to = reinterpret_cast<Lanes<T>*>(out + outRow);
    to[0] = b0;
    to[1] = b1;
    to = reinterpret_cast<Lanes<T>*>(out + 2 * outRow);
    to[0] = c0;
    to[1] = c1;
    to = reinterpret_cast<Lanes<T>*>(out + 3 * outRow);
    to[0] = d0;
    to[1] = d1;
}

TESSERA_VECTOR_CLONES
void multiplyTiles(const MatrixView& left, const double* right, size_t rightStride, size_t length,
                   double* out, size_t outStride, size_t columns) {
    for (size_t column = 0; column < columns; column += kTileColumns<double>)
        multiplyTile(left.data, left.rowStep, left.columnStep, right + column, rightStride, length,
                     out + column, outStride);
}

// The tiles of the lower triangle, in out's rows of `stride` numbers.
TESSERA_VECTOR_CLONES
void multiplyByItself(const float* rows, size_t count, size_t stride, size_t columns, float* out) {
    for (size_t row = 0; row < columns; row += kTileRows)
        for (size_t column = 0; column < row + kTileRows; column += kTileColumns<float>)
            multiplyTile(rows + row, stride, 1, rows + column, stride, count, out + row * stride + column,
                         stride);
}

}  // namespace

void addRows(std::span<const double> factors, const double* rows, size_t stride, std::span<double> sums) {
    addRowsTo(factors.data(), factors.size(), rows, stride, sums.data(), sums.size());
}

void multiplyFour(const MatrixView& left, const double* right, size_t rightStride, size_t length, double* out,
                  size_t outStride, size_t columns) {
    TESSERA_CHECK(columns % kTileColumns<double> == 0);
    multiplyTiles(left, right, rightStride, length, out, outStride, columns);
}

std::vector<double> lowerProducts(std::span<const double> left, std::span<const double> right, size_t rows,
                                  size_t length) {
    TESSERA_CHECK(left.size() == rows * length && right.size() == rows * length);
    constexpr size_t kWide = kTileColumns<double>;
    // Panels of as many columns of the product as a tile has, and rows up to a multiple of the tile's.
    const size_t stride = roundUp(rows, kTileRows);
    std::vector<double> products(rows * rows, 0), panel(kWide * length, 0), last;
    std::array<double, kTileRows * kWide> tile{};
    if (stride > rows) {
        last.assign(kTileRows * length, 0);
        const size_t first = stride - kTileRows;
        std::copy(left.begin() + ptrdiff_t(first * length), left.end(), last.begin());
    }
    for (size_t column = 0; column < rows; column += kWide) {
        const size_t columns = std::min(kWide, rows - column);
        for (size_t j = 0; j < columns; ++j)
            for (size_t i = 0; i < length; ++i) panel[i * kWide + j] = right[(column + j) * length + i];
        for (size_t row = column; row < rows; row += kTileRows) {
            const double* from = row + kTileRows > rows ? last.data() : &left[row * length];
            multiplyTiles({from, 1, length}, panel.data(), kWide, length, tile.data(), kWide, kWide);
            for (size_t k = row; k < std::min(row + kTileRows, rows); ++k)
                std::copy_n(&tile[(k - row) * kWide], std::min(columns, k + 1 - column),
                            &products[k * rows + column]);
        }
    }
    return products;
}

std::vector<float> gram(std::span<const float> rows, size_t count, size_t columns) {
    const size_t stride = gramStride(columns);
    static_assert(gramStride(1) % kTileColumns<float> == 0 && gramStride(1) % kTileRows == 0);
    TESSERA_CHECK(rows.size() == count * stride);
    std::vector<float> lower(stride * stride, 0), all(columns * columns);
    multiplyByItself(rows.data(), count, stride, columns, lower.data());
    for (size_t k = 0; k < columns; ++k)
        for (size_t j = 0; j <= k; ++j) all[k * columns + j] = all[j * columns + k] = lower[k * stride + j];
    return all;
}

}  // namespace tessera
