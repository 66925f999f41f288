// An array in pages that copies share until one of them writes: a copy of a mesh is a snapshot that costs a
// pointer a page, and an edit costs the pages that it touches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/base/check.h"

namespace tessera {

// Concurrent reads are safe; a write needs the array to itself (other copies may be read meanwhile).
template <class T, size_t kPageBits = 9>
class PagedArray {
  public:
    static constexpr size_t kPageSize = size_t{1} << kPageBits;

    PagedArray() = default;
    explicit PagedArray(size_t count, const T& value = T{}) { resize(count, value); }

    size_t size() const { return mSize; }
    bool empty() const { return mSize == 0; }

    const T& operator[](size_t i) const { return mPages[i >> kPageBits]->at[i & (kPageSize - 1)]; }

    // The element, for writing: its page is copied first where another array shares it.
    T& edit(size_t i) {
        std::shared_ptr<Page>& page = mPages[i >> kPageBits];
        if (page.use_count() != 1) page = std::make_shared<Page>(*page);
        return page->at[i & (kPageSize - 1)];
    }

    // Sets the elements of ascending, different `indices` to `values`, which are moved. Of a page that
    // another array shares only the others are copied first.
    void replace(std::span<const size_t> indices, std::span<T> values) {
        TESSERA_CHECK(indices.size() == values.size());
        for (size_t first = 0, end = 0; first < indices.size(); first = end) {
            const size_t number = indices[first] >> kPageBits;
            while (end < indices.size() && indices[end] >> kPageBits == number) ++end;
            std::shared_ptr<Page>& page = mPages[number];
            if (page.use_count() != 1) {
                const auto fresh = std::make_shared<Page>();
                for (size_t i = 0, next = first; i < kPageSize; ++i) {
                    if (next < end && (indices[next] & (kPageSize - 1)) == i)
                        ++next;
                    else
                        fresh->at[i] = page->at[i];
                }
                page = fresh;
            }
            for (size_t i = first; i < end; ++i)
                page->at[indices[i] & (kPageSize - 1)] = std::move(values[i]);
        }
    }

    void pushBack(const T& value) {
        if (mSize == mPages.size() * kPageSize) mPages.push_back(std::make_shared<Page>());
        ++mSize;
        edit(mSize - 1) = value;
    }

    void resize(size_t count, const T& value = T{}) {
        if (count < mSize) {
            mSize = count;
            mPages.resize((count + kPageSize - 1) >> kPageBits);
            return;
        }
        mPages.reserve((count + kPageSize - 1) >> kPageBits);
        while (mSize < count) pushBack(value);
    }

    // Whether element i is, in memory, the very same in both arrays (so that nothing has changed it).
    bool sharesPage(const PagedArray& other, size_t i) const {
        return i < mSize && i < other.mSize && mPages[i >> kPageBits] == other.mPages[i >> kPageBits];
    }

    bool operator==(const PagedArray& other) const {
        if (mSize != other.mSize) return false;
        for (size_t page = 0; page < mPages.size(); ++page) {
            if (mPages[page] == other.mPages[page]) continue;
            const T* from = mPages[page]->at;
            if (!std::equal(from, from + std::min(kPageSize, mSize - page * kPageSize),
                            other.mPages[page]->at))
                return false;
        }
        return true;
    }

    // The memory of the pages that `other` does not share, in bytes, and of the list of pages;
    // `outside(element, before)` is what an element holds beyond itself, and does not share with the one in
    // its place in `other`, null where there is none.
    template <class Outside>
    size_t bytesBeyond(const PagedArray& other, Outside&& outside) const {
        size_t bytes = mPages.size() * sizeof(mPages[0]);
        for (size_t page = 0; page < mPages.size(); ++page) {
            const Page* const before = page < other.mPages.size() ? other.mPages[page].get() : nullptr;
            if (mPages[page].get() == before) continue;
            bytes += sizeof(Page);
            for (size_t i = 0; i < kPageSize; ++i)
                bytes += outside(mPages[page]->at[i], before ? before->at + i : nullptr);
        }
        return bytes;
    }
    size_t bytesBeyond(const PagedArray& other) const {
        return bytesBeyond(other, [](const T&, const T*) { return size_t{0}; });
    }

  private:
    struct Page {
        T at[kPageSize]{};
    };

    std::vector<std::shared_ptr<Page>> mPages;
    size_t mSize = 0;
};

}  // namespace tessera
