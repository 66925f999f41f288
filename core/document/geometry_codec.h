// Control points, edge attributes and smooth joins to and from range-coded streams, in the numbering of a
// FileMesh.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/document/file_mesh.h"
#include "core/document/range_coder.h"
#include "core/mesh/blur_profile.h"
#include "core/mesh/lattice.h"

namespace tessera {

// Everything of a mesh but its triangles and colours, by the file's ids.
struct FileGeometry {
    int width = 0, height = 0;
    std::vector<LatticePoint> positions;
    std::vector<std::array<LatticePoint, 2>> inner;  // of each edge, in its direction
    std::vector<LatticePoint> interior;

    struct Attributes {
        bool feature = false;
        std::array<int64_t, 2> blur{};  // 1/256 px

        bool operator==(const Attributes&) const = default;
    };
    std::vector<Attributes> attributes;

    struct Join {
        uint32_t vertex = 0, first = 0, second = 0;  // edges; first < second

        auto operator<=>(const Join&) const = default;
    };
    std::vector<Join> joins;  // ascending, none twice
};

constexpr int64_t kBlurStepsPerPixel = 256;
constexpr int64_t kMaxBlurSteps = int64_t(kWidestBlurPx * kBlurStepsPerPixel);
// Control points lie within this many lattice steps of 0.
constexpr int64_t kMaxCoordinate = 2 * int64_t(kMaxPictureSide) * kLatticePerPixel;

// Both directions return what is wrong, or empty. Decoding sizes the arrays by the mesh. Encoding is of the
// newest version.
std::string encodeGeometry(RangeEncoder& coder, const FileMesh& mesh, FileGeometry& geometry);
std::string decodeGeometry(RangeDecoder& coder, uint32_t version, const FileMesh& mesh,
                           FileGeometry& geometry);
std::string encodeAttributes(RangeEncoder& coder, const FileMesh& mesh, FileGeometry& geometry);
std::string decodeAttributes(RangeDecoder& coder, const FileMesh& mesh, FileGeometry& geometry);

// What keeps the border from running once, in straight sides, from corner to corner of the picture; or empty.
std::string borderViolation(const FileMesh& mesh, const FileGeometry& geometry);

}  // namespace tessera
