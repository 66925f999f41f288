// Rows in 16 bits: what comes back, and products.
#include "core/vectorize/packed_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tessera {
namespace {

constexpr size_t kRows = 30, kColumns = 21;

struct Sample {
    std::vector<std::vector<float>> rows;
    PackedRows packed;
};

Sample sample() {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    Sample s;
    for (size_t i = 0; i < kRows; ++i) {
        std::vector<float> row;
        for (size_t k = 0; k < kColumns; ++k) row.push_back(uniform(random) * float(i + 1));
        s.packed.push(row);
        s.rows.push_back(row);
    }
    return s;
}

TEST(PackedRows, KeepTheDigitsOfEachRow) {
    const Sample s = sample();
    ASSERT_EQ(s.packed.size(), kRows);
    for (size_t i = 0; i < kRows; ++i) {
        std::vector<float> row(kColumns, 0);
        s.packed.addTo(i, row);
        for (size_t k = 0; k < kColumns; ++k) EXPECT_NEAR(row[k], s.rows[i][k], float(i + 1) / 65000);
    }
}

TEST(PackedRows, ProductsAreThoseOfTheRows) {
    const Sample s = sample();
    for (const size_t columns : {size_t(3), size_t(8), kColumns}) {
        std::vector<float> x(columns), products(kRows), sum(columns), factors(kRows);
        for (size_t k = 0; k < columns; ++k) x[k] = .3F + .1F * float(k);
        for (size_t i = 0; i < kRows; ++i) factors[i] = std::sin(float(i));
        s.packed.multiply(x, products);
        s.packed.multiplyTransposed(factors, sum);
        std::vector<double> wanted(columns, 0);
        for (size_t i = 0; i < kRows; ++i) {
            double product = 0;
            for (size_t k = 0; k < columns; ++k) {
                product += double(s.rows[i][k]) * (.3 + .1 * double(k));
                wanted[k] += double(factors[i]) * double(s.rows[i][k]);
            }
            EXPECT_NEAR(products[i], product, 2e-4 * double(i + 1)) << columns;
        }
        for (size_t k = 0; k < columns; ++k) EXPECT_NEAR(sum[k], wanted[k], 2e-3);
    }
}

TEST(PackedRows, ZerosStayZeros) {
    PackedRows packed;
    const std::vector<float> zeros(5, 0), ones(5, 1);
    packed.push(zeros);
    packed.push(ones);
    std::vector<float> products(2), row(5, 2);
    packed.multiply(ones, products);
    EXPECT_EQ(products[0], 0);
    EXPECT_NEAR(products[1], 5, 1e-3);
    packed.addTo(0, row);
    EXPECT_EQ(row, std::vector<float>(5, 2));
}

}  // namespace
}  // namespace tessera
