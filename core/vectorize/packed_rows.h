// Rows of a matrix in half the memory of floats: 16-bit integers times a scale of the row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera {

class PackedRows {
  public:
    // Each entry is off by at most 1/65534 of the row's largest.
    void push(std::span<const float> row);
    // Adds row i to `row`, or its first row.size() entries.
    void addTo(size_t i, std::span<float> row) const;

    size_t size() const { return mScales.size(); }
    void reserve(size_t rows, size_t columns);
    void shrink();

    // The products of all rows with x, whose entries are by the first columns.
    void multiply(std::span<const float> x, std::span<float> products) const;
    // The sum of all rows times their factor, over the first sum.size() columns.
    void multiplyTransposed(std::span<const float> factors, std::span<float> sum) const;

  private:
    size_t mStride = 0;  // rows are filled up with zeros to whole vectors
    std::vector<int16_t> mEntries;
    std::vector<float> mScales;  // by row
};

}  // namespace tessera
