// A GPU buffer of records with a copy in memory: what is set to another value is uploaded, once a frame, in
// as few pieces as pay.
#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

#include "render/gl_objects.h"
#include "render/gpu_layout.h"

namespace tessera::render {

// Indices [begin, end).
struct IndexRange {
    size_t begin = 0;
    size_t end = 0;
    bool operator==(const IndexRange&) const = default;
};

// Sorts the indices and joins those below `count` with at most `gap` unchanged ones between them. Those from
// `count` on were changed before the records became fewer.
std::vector<IndexRange> coalesced(std::vector<uint32_t>& indices, size_t count, size_t gap);

template <class Record>
class MirrorBuffer {
    static_assert(std::is_trivially_copyable_v<Record>);

  public:
    explicit MirrorBuffer(GLenum format) : mBuffer(format) {}

    size_t size() const { return mRecords.size(); }
    const Record& operator[](size_t i) const { return mRecords[i]; }
    void bind(Unit unit) const { mBuffer.bindTexels(unit); }

    void resize(size_t count) {
        const size_t before = mRecords.size();
        mRecords.resize(count);
        for (size_t i = before; i < count; ++i) mDirty.push_back(uint32_t(i));
    }
    void set(size_t i, const Record& record) {
        if (std::memcmp(&mRecords[i], &record, sizeof(Record)) == 0) return;
        mRecords[i] = record;
        mDirty.push_back(uint32_t(i));
    }
    // Returns how many bytes went to the GPU.
    size_t upload() {
        // A call costs about as much as the bytes of a few records.
        constexpr size_t kGap = 8;
        size_t bytes = 0;
        if (mBuffer.reserve(mRecords.size() * sizeof(Record))) {
            mDirty.clear();
            if (!mRecords.empty()) bytes += write({0, mRecords.size()});
        }
        for (const IndexRange& range : coalesced(mDirty, mRecords.size(), kGap)) bytes += write(range);
        mDirty.clear();
        return bytes;
    }

  private:
    size_t write(const IndexRange& range) {
        const size_t bytes = (range.end - range.begin) * sizeof(Record);
        mBuffer.write(range.begin * sizeof(Record), &mRecords[range.begin], bytes);
        return bytes;
    }

    std::vector<Record> mRecords;
    std::vector<uint32_t> mDirty;
    Buffer mBuffer;
};

}  // namespace tessera::render
