// Typed 32-bit indices into the arrays of a mesh: a vertex id is not a face id. No pointer to an element is
// ever kept.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <limits>

namespace tessera {

template <class Tag>
struct Id {
    static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

    uint32_t index = kNone;

    constexpr Id() = default;
    constexpr explicit Id(uint32_t i) : index(i) {}
    constexpr bool valid() const { return index != kNone; }
    constexpr auto operator<=>(const Id&) const = default;
};

using VertexId = Id<struct VertexTag>;
using HalfedgeId = Id<struct HalfedgeTag>;
using EdgeId = Id<struct EdgeTag>;
// A face of the connectivity; in a PatchMesh the face and the patch over it have the same id.
using FaceId = Id<struct FaceTag>;
using PatchId = FaceId;

}  // namespace tessera

template <class Tag>
struct std::hash<tessera::Id<Tag>> {
    size_t operator()(tessera::Id<Tag> id) const noexcept { return std::hash<uint32_t>()(id.index); }
};
