// See packed_rows.h.
#include "core/vectorize/packed_rows.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/round_up.h"
#include "core/base/vector_clones.h"

namespace tessera {

namespace {

constexpr size_t kLanes = 8;

size_t padded(size_t columns) {
    return roundUp(columns, kLanes);
}

int16_t nearest(float x) {
    return int16_t(x + std::copysign(.5F, x));
}

// The same sum with and without vector instructions: one for each lane, then those.
TESSERA_VECTOR_CLONES
void multiplyRows(const int16_t* entries, const float* scales, size_t rows, size_t stride, const float* x,
                  size_t columns, float* products) {
    for (size_t i = 0; i < rows; ++i) {
        const int16_t* row = entries + i * stride;
        float sums[kLanes] = {};
        for (size_t k = 0; k < columns; k += kLanes)
            for (size_t lane = 0; lane < kLanes; ++lane) sums[lane] += float(row[k + lane]) * x[k + lane];
        const float low = (sums[0] + sums[4]) + (sums[1] + sums[5]);
        const float high = (sums[2] + sums[6]) + (sums[3] + sums[7]);
        products[i] = scales[i] * (low + high);
    }
}

TESSERA_VECTOR_CLONES
void addRows(const int16_t* entries, const float* scales, size_t rows, size_t stride, const float* factors,
             size_t columns, float* sum) {
    for (size_t i = 0; i < rows; ++i) {
        const int16_t* row = entries + i * stride;
        const float factor = scales[i] * factors[i];
        for (size_t k = 0; k < columns; ++k) sum[k] += factor * float(row[k]);
    }
}

}  // namespace

void PackedRows::push(std::span<const float> row) {
    if (mScales.empty()) mStride = padded(row.size());
    TESSERA_CHECK(padded(row.size()) == mStride);
    float most = 0;
    for (const float entry : row) most = std::max(most, std::abs(entry));
    const float scale = most > 0 ? most / 32767 : 1;
    mScales.push_back(scale);
    for (const float entry : row) mEntries.push_back(nearest(entry / scale));
    mEntries.resize(mScales.size() * mStride, 0);
}

void PackedRows::addTo(size_t i, std::span<float> row) const {
    for (size_t k = 0; k < row.size(); ++k) row[k] += float(mEntries[i * mStride + k]) * mScales[i];
}

void PackedRows::reserve(size_t rows, size_t columns) {
    mEntries.reserve(rows * padded(columns));
    mScales.reserve(rows);
}

void PackedRows::shrink() {
    mEntries.shrink_to_fit();
    mScales.shrink_to_fit();
}

void PackedRows::multiply(std::span<const float> x, std::span<float> products) const {
    const size_t columns = padded(x.size());
    TESSERA_CHECK(columns <= mStride || size() == 0);
    std::vector<float> filled(columns, 0);
    std::copy(x.begin(), x.end(), filled.begin());
    multiplyRows(mEntries.data(), mScales.data(), size(), mStride, filled.data(), columns, products.data());
}

void PackedRows::multiplyTransposed(std::span<const float> factors, std::span<float> sum) const {
    std::fill(sum.begin(), sum.end(), 0.0F);
    addRows(mEntries.data(), mScales.data(), size(), mStride, factors.data(), sum.size(), sum.data());
}

}  // namespace tessera
