// See row_products.h.
#include "core/base/row_products.h"

#include <algorithm>
#include <array>

#include "core/base/check.h"
#include "core/base/vector_clones.h"

namespace tessera {

namespace {

constexpr size_t kLanes = 4;
constexpr size_t kTileRows = 4, kTileColumns = 2 * kLanes;
typedef double Lanes
    __attribute__((vector_size(kLanes * sizeof(double)), aligned(alignof(double)), may_alias));

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

TESSERA_VECTOR_CLONES
void multiplyTiles(const MatrixView& left, const double* right, size_t rightStride, size_t length,
                   double* out, size_t outStride, size_t columns) {
    const size_t step = left.rowStep, next = left.columnStep;
    for (size_t column = 0; column < columns; column += kTileColumns) {
        Lanes a0{}, a1{}, b0{}, b1{}, c0{}, c1{}, d0{}, d1{};
        const double *from = left.data, *row = right + column;
        for (size_t i = 0; i < length; ++i, from += step, row += rightStride) {
            const Lanes* lanes = reinterpret_cast<const Lanes*>(row);
            const Lanes x = lanes[0], y = lanes[1];
            const double a = from[0], b = from[next], c = from[2 * next], d = from[3 * next];
            a0 += a * x;
            a1 += a * y;
            b0 += b * x;
            b1 += b * y;
            c0 += c * x;
            c1 += c * y;
            d0 += d * x;
            d1 += d * y;
        }
        const auto store = [&](size_t r, Lanes x, Lanes y) {
            Lanes* to = reinterpret_cast<Lanes*>(out + r * outStride + column);
            to[0] = x;
            to[1] = y;
        };
        store(0, a0, a1);
        store(1, b0, b1);
        store(2, c0, c1);
        store(3, d0, d1);
    }
}

}  // namespace

void addRows(std::span<const double> factors, const double* rows, size_t stride, std::span<double> sums) {
    addRowsTo(factors.data(), factors.size(), rows, stride, sums.data(), sums.size());
}

void multiplyFour(const MatrixView& left, const double* right, size_t rightStride, size_t length, double* out,
                  size_t outStride, size_t columns) {
    TESSERA_CHECK(columns % kTileColumns == 0);
    multiplyTiles(left, right, rightStride, length, out, outStride, columns);
}

std::vector<double> lowerProducts(std::span<const double> left, std::span<const double> right, size_t rows,
                                  size_t length) {
    TESSERA_CHECK(left.size() == rows * length && right.size() == rows * length);
    // Panels of as many columns of the product as a tile has, and rows up to a multiple of the tile's.
    const size_t stride = (rows + kTileRows - 1) / kTileRows * kTileRows;
    std::vector<double> products(rows * rows, 0), panel(kTileColumns * length, 0), last;
    std::array<double, kTileRows * kTileColumns> tile{};
    if (stride > rows) {
        last.assign(kTileRows * length, 0);
        const size_t first = stride - kTileRows;
        std::copy(left.begin() + ptrdiff_t(first * length), left.end(), last.begin());
    }
    for (size_t column = 0; column < rows; column += kTileColumns) {
        const size_t columns = std::min(kTileColumns, rows - column);
        for (size_t j = 0; j < columns; ++j)
            for (size_t i = 0; i < length; ++i)
                panel[i * kTileColumns + j] = right[(column + j) * length + i];
        for (size_t row = column; row < rows; row += kTileRows) {
            const double* from = row + kTileRows > rows ? last.data() : &left[row * length];
            multiplyTiles({from, 1, length}, panel.data(), kTileColumns, length, tile.data(), kTileColumns,
                          kTileColumns);
            for (size_t k = row; k < std::min(row + kTileRows, rows); ++k)
                std::copy_n(&tile[(k - row) * kTileColumns], std::min(columns, k + 1 - column),
                            &products[k * rows + column]);
        }
    }
    return products;
}

}  // namespace tessera
