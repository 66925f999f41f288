// A list that never changes, which copies share: to copy one costs a count, however long it is.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

namespace tessera {

// A value: assigning another list is how it is changed. A range of const elements, hence also a span.
template <class T>
class SharedList {
  public:
    SharedList() = default;
    // (Implicit, as a list is what its elements are.)
    SharedList(std::span<const T> elements) : mSize(uint32_t(elements.size())) {
        if (elements.empty()) return;
        const auto copy = std::make_shared_for_overwrite<T[]>(elements.size());
        std::copy(elements.begin(), elements.end(), copy.get());
        mElements = copy;
    }
    SharedList(const std::vector<T>& elements) : SharedList(std::span<const T>(elements)) {}
    SharedList(std::initializer_list<T> elements)
        : SharedList(std::span<const T>(elements.begin(), elements.size())) {}

    size_t size() const { return mSize; }
    bool empty() const { return mSize == 0; }
    const T* data() const { return mElements.get(); }
    const T* begin() const { return data(); }
    const T* end() const { return data() + mSize; }
    const T& operator[](size_t i) const { return mElements[i]; }

    bool operator==(const SharedList& other) const {
        return mSize == other.mSize && (data() == other.data() || std::equal(begin(), end(), other.begin()));
    }
    // Whether both are the very same memory.
    bool shares(const SharedList& other) const { return data() == other.data(); }

  private:
    std::shared_ptr<const T[]> mElements;
    uint32_t mSize = 0;
};

}  // namespace tessera
