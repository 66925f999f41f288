// The chunks of a document outside its mesh: settings, report, source and difference as bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image_compare.h"
#include "core/image/image_io.h"
#include "core/vectorize/settings.h"

namespace tessera {

// Text-like bytes by the range coder with the last byte as context: as small as zstd makes them, and the same
// for ever.
std::vector<uint8_t> packText(std::span<const uint8_t> bytes);
Result<std::vector<uint8_t>> unpackText(std::span<const uint8_t> bytes);

// Each decoder returns what is wrong, or empty.
std::vector<uint8_t> encodeSettings(const VectorizeSettings& settings);
std::string decodeSettings(std::span<const uint8_t> bytes, VectorizeSettings& settings);
std::vector<uint8_t> encodeReport(const VectorizeReport& report);
std::string decodeReport(std::span<const uint8_t> bytes, VectorizeReport& report);
std::vector<uint8_t> encodeSource(const SourceInfo& source);
std::string decodeSource(std::span<const uint8_t> bytes, SourceInfo& source);
std::vector<uint8_t> encodeDifference(const ImageDifference& difference);
std::string decodeDifference(std::span<const uint8_t> bytes, ImageDifference& difference);

}  // namespace tessera
