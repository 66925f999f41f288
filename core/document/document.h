// A Tessera document: everything that a .tessera file holds, as a value. Copies share what is large.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/edit/patch_set.h"
#include "core/image/image_compare.h"
#include "core/image/image_io.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/settings.h"

namespace tessera {

// A chunk that this version does not know, kept as it came. Dropped by an edit where it is not safe to copy.
struct UnknownChunk {
    std::array<char, 4> tag{};
    bool safeToCopy = false;
    std::vector<uint8_t> bytes;

    bool operator==(const UnknownChunk&) const = default;
};

struct NamedSelection {
    std::string name;
    PatchSet patches;

    bool operator==(const NamedSelection&) const = default;
};

struct Document {
    PatchMesh mesh;
    // The mesh as it was vectorized, for ways back to it; shares what no edit has changed. Patches that edits
    // of the connectivity replaced have no counterpart there (hasFitted). None where nothing was edited.
    std::optional<PatchMesh> fitted;
    std::vector<NamedSelection> selections;
    // The step, in colour units (1 is 255 levels), to which colours are rounded in the file. Chosen at the
    // first encoding, then kept for ever: decoding and encoding again gives the same bytes. For splines of
    // the default centres no pixel moves by more than 0.1 level; for splines on sites the picture loses at
    // most 0.1 dB of the PSNR in `difference`, or of 45 dB where there is none, and less where it is low.
    std::optional<double> colourStep;
    VectorizeSettings settings;
    VectorizeReport report;
    std::optional<ImageDifference> difference;  // of the x1 rendering from the source
    SourceInfo source;
    std::shared_ptr<const std::vector<uint8_t>> embeddedSource;  // the source file's bytes; may be null
    std::shared_ptr<const std::vector<uint8_t>> previewPng;      // at most 512 x 512; may be null
    std::vector<UnknownChunk> unknownChunks;

    // To be called by whatever changes the mesh: drops what is no longer true (unknown chunks that are not
    // safe to copy, the preview, the difference).
    void markEdited();
};

}  // namespace tessera
