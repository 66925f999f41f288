#include "core/base/row_products.h"

#include <gtest/gtest.h>

#include <random>

namespace tessera {
namespace {

std::vector<double> randomNumbers(size_t count) {
    static std::mt19937_64 random(7);
    std::uniform_real_distribution<double> numbers(-1, 1);
    std::vector<double> result(count);
    for (double& x : result) x = numbers(random);
    return result;
}

// To the last bit: the order of the sums is part of the file format.
TEST(RowProducts, AddsRowsInOrder) {
    for (const size_t count : {0, 1, 3, 4, 7, 12})
        for (const size_t length : {1, 5, 8, 33}) {
            const size_t stride = length + 2;
            const auto factors = randomNumbers(count), rows = randomNumbers(count * stride + 1);
            auto expected = randomNumbers(length), sums = expected;
            for (size_t i = 0; i < length; ++i)
                for (size_t j = 0; j < count; ++j) expected[i] += factors[j] * rows[j * stride + i];
            addRows(factors, rows.data(), stride, sums);
            EXPECT_EQ(sums, expected) << count << " rows of " << length;
        }
}

TEST(RowProducts, LowerTriangleOfAProductInOrder) {
    for (const size_t rows : {1, 3, 4, 8, 9, 15, 30})
        for (const size_t length : {1, 4, 21}) {
            const auto left = randomNumbers(rows * length), right = randomNumbers(rows * length);
            std::vector<double> expected(rows * rows, 0);
            for (size_t k = 0; k < rows; ++k)
                for (size_t j = 0; j <= k; ++j)
                    for (size_t i = 0; i < length; ++i)
                        expected[k * rows + j] += left[k * length + i] * right[j * length + i];
            EXPECT_EQ(lowerProducts(left, right, rows, length), expected) << rows << " rows of " << length;
        }
}

TEST(RowProducts, FourRowsWhateverTheSteps) {
    constexpr size_t kLength = 11, kColumns = 16, kRightStride = 19, kOutStride = 17;
    const auto right = randomNumbers(kLength * kRightStride), left = randomNumbers(4 * kLength);
    for (const auto& [rowStep, columnStep] : {std::pair<size_t, size_t>{1, kLength}, {4, 1}}) {
        std::vector<double> out(4 * kOutStride, 0), expected(out);
        for (size_t r = 0; r < 4; ++r)
            for (size_t j = 0; j < kColumns; ++j)
                for (size_t i = 0; i < kLength; ++i)
                    expected[r * kOutStride + j] +=
                        left[i * rowStep + r * columnStep] * right[i * kRightStride + j];
        multiplyFour({left.data(), rowStep, columnStep}, right.data(), kRightStride, kLength, out.data(),
                     kOutStride, kColumns);
        EXPECT_EQ(out, expected);
    }
}

TEST(RowProducts, AGramMatrix) {
    for (const size_t columns : {1, 15, 16, 33})
        for (const size_t count : {1, 6}) {
            const size_t stride = gramStride(columns);
            std::vector<float> rows(count * stride, 9);  // what is beyond the columns counts for nothing
            const auto numbers = randomNumbers(rows.size());
            for (size_t i = 0; i < rows.size(); ++i)
                if (i % stride < columns) rows[i] = float(numbers[i]);
            std::vector<float> expected(columns * columns, 0);
            for (size_t k = 0; k < columns; ++k)
                for (size_t j = 0; j < columns; ++j)
                    for (size_t i = 0; i < count; ++i)
                        expected[k * columns + j] += rows[i * stride + k] * rows[i * stride + j];
            EXPECT_EQ(gram(rows, count, columns), expected) << count << " rows of " << columns;
        }
}

}  // namespace
}  // namespace tessera
