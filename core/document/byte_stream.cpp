// See byte_stream.h.
#include "core/document/byte_stream.h"

namespace tessera {

void ByteWriter::raw(std::span<const uint8_t> bytes) {
    mBytes.insert(mBytes.end(), bytes.begin(), bytes.end());
}

void ByteWriter::string(std::string_view text) {
    u32(uint32_t(text.size()));
    mBytes.insert(mBytes.end(), text.begin(), text.end());
}

void ByteWriter::word(uint64_t value, int count) {
    for (int i = 0; i < count; ++i) mBytes.push_back(uint8_t(value >> 8 * i));
}

std::span<const uint8_t> ByteReader::raw(uint64_t count) {
    if (count > left()) {
        mFailed = true;
        mAt = mBytes.size();
        return {};
    }
    const auto part = mBytes.subspan(mAt, size_t(count));
    mAt += size_t(count);
    return part;
}

std::string ByteReader::string() {
    const auto part = raw(u32());
    return {part.begin(), part.end()};
}

uint64_t ByteReader::word(int count) {
    const auto part = raw(uint64_t(count));
    uint64_t value = 0;
    for (size_t i = part.size(); i-- > 0;) value = value << 8 | part[i];
    return value;
}

}  // namespace tessera
