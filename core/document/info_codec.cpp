// See info_codec.h.
#include "core/document/info_codec.h"

#include <algorithm>
#include <array>
#include <memory>

#include "core/document/byte_stream.h"
#include "core/document/range_coder.h"

namespace tessera {

namespace {

// A text may be this many times larger than its packed bytes; packText adds zeros where it would be more.
constexpr uint64_t kMaxTextInflation = 64;

struct TextModels {
    std::array<std::array<BitModel, 256>, 256> models;  // by the byte before and the bits so far
    uint8_t last = '\n';

    template <class Coder>
    void code(Coder& coder, uint8_t& byte) {
        size_t bits = 1;
        for (int i = 7; i >= 0; --i) {
            bool bit = (byte >> i & 1) != 0;
            coder.bit(models[last][bits], bit);
            bits = bits << 1 | size_t(bit);
        }
        byte = last = uint8_t(bits);
    }
};

const char* const kEndsEarly = "ends early";

bool isSettingKey(const std::string& key) {
    static const auto known = toKeyValues(VectorizeSettings{});
    return key.starts_with("stage.") ||
           std::any_of(known.begin(), known.end(), [&](const auto& k) { return k.first == key; });
}

}  // namespace

std::vector<uint8_t> packText(std::span<const uint8_t> bytes) {
    RangeEncoder coder;
    auto models = std::make_unique<TextModels>();
    for (uint8_t byte : bytes) models->code(coder, byte);
    ByteWriter out;
    out.u32(uint32_t(bytes.size()));
    out.raw(coder.finish());
    while (out.size() * kMaxTextInflation < bytes.size()) out.u8(0);
    return out.take();
}

Result<std::vector<uint8_t>> unpackText(std::span<const uint8_t> bytes) {
    ByteReader reader(bytes);
    const uint32_t size = reader.u32();
    if (reader.failed() || size / kMaxTextInflation > bytes.size())
        return failure(ErrorCode::DamagedDocument, kEndsEarly);
    RangeDecoder coder(reader.raw(reader.left()));
    auto models = std::make_unique<TextModels>();
    std::vector<uint8_t> text(size);
    for (uint8_t& byte : text) models->code(coder, byte);
    if (coder.overrun()) return failure(ErrorCode::DamagedDocument, kEndsEarly);
    return text;
}

std::vector<uint8_t> encodeSettings(const VectorizeSettings& settings) {
    std::vector<uint8_t> text;
    for (const auto& [key, value] : toKeyValues(settings)) {
        const std::string line = key + "=" + value + "\n";
        text.insert(text.end(), line.begin(), line.end());
    }
    return packText(text);
}

std::string decodeSettings(std::span<const uint8_t> bytes, VectorizeSettings& settings) {
    const auto text = unpackText(bytes);
    if (!text) return text.error().message;
    for (auto at = text->begin(); at != text->end();) {
        const auto end = std::find(at, text->end(), '\n');
        const auto equals = std::find(at, end, '=');
        if (end == text->end() || equals == end) return "has a line that is no key=value";
        const std::string key(at, equals), value(equals + 1, end);
        // Keys of later programs are passed over: a setting explains a mesh, it does not change one.
        if (isSettingKey(key))
            if (const auto set = setKeyValue(settings, key, value); !set)
                return "is refused: " + set.error().message;
        at = end + 1;
    }
    return {};
}

std::vector<uint8_t> encodeReport(const VectorizeReport& report) {
    ByteWriter out;
    out.string(report.shortfall);
    out.u32(uint32_t(report.stages.size()));
    for (const StageReport& stage : report.stages) {
        out.string(stage.stage);
        out.string(stage.variant);
        out.f64(stage.seconds);
        out.u32(uint32_t(stage.figures.size()));
        for (const auto& [name, value] : stage.figures) {
            out.string(name);
            out.f64(value);
        }
    }
    return packText(out.bytes());
}

std::string decodeReport(std::span<const uint8_t> bytes, VectorizeReport& report) {
    const auto text = unpackText(bytes);
    if (!text) return text.error().message;
    ByteReader in(*text);
    report.shortfall = in.string();
    for (uint32_t stages = in.u32(); stages > 0 && !in.failed(); --stages) {
        StageReport& stage = report.stages.emplace_back();
        stage.stage = in.string();
        stage.variant = in.string();
        stage.seconds = in.f64();
        for (uint32_t figures = in.u32(); figures > 0 && !in.failed(); --figures) {
            std::string name = in.string();
            const double value = in.f64();
            stage.figures.emplace_back(std::move(name), value);
        }
    }
    return in.failed() ? kEndsEarly : in.left() != 0 ? "has bytes left over" : "";
}

std::vector<uint8_t> encodeSource(const SourceInfo& source) {
    ByteWriter out;
    out.string(source.fileName);
    out.u64(source.byteSize);
    out.string(source.sha256);
    out.string(source.format);
    out.u32(uint32_t(source.width));
    out.u32(uint32_t(source.height));
    out.u32(uint32_t(source.bitsPerChannel));
    return out.take();
}

std::string decodeSource(std::span<const uint8_t> bytes, SourceInfo& source) {
    ByteReader in(bytes);
    source.fileName = in.string();
    source.byteSize = in.u64();
    source.sha256 = in.string();
    source.format = in.string();
    source.width = int(in.u32());
    source.height = int(in.u32());
    source.bitsPerChannel = int(in.u32());
    return in.failed() ? kEndsEarly : in.left() != 0 ? "has bytes left over" : "";
}

std::vector<uint8_t> encodeDifference(const ImageDifference& d) {
    ByteWriter out;
    for (const double v : {d.mae, d.maeChannel[0], d.maeChannel[1], d.maeChannel[2], d.euclid, d.rmse, d.psnr,
                           d.maeLuma, d.psnrLuma})
        out.f64(v);
    if (d.ssim) out.f64(*d.ssim);
    return out.take();
}

std::string decodeDifference(std::span<const uint8_t> bytes, ImageDifference& d) {
    ByteReader in(bytes);
    for (double* v : {&d.mae, &d.maeChannel[0], &d.maeChannel[1], &d.maeChannel[2], &d.euclid, &d.rmse,
                      &d.psnr, &d.maeLuma, &d.psnrLuma})
        *v = in.f64();
    if (in.left() != 0) d.ssim = in.f64();
    return in.failed() ? kEndsEarly : in.left() != 0 ? "has bytes left over" : "";
}

}  // namespace tessera
