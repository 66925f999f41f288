// The lattice of 1/256 pixel on which every vertex and control point lies, in memory as in the file: what is
// certified is exactly what is stored.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <glm/vec2.hpp>

namespace tessera {

constexpr int kLatticePerPixel = 256;

// Pictures are at most so wide and high, px. Control points may lie as far outside; beyond, certificates and
// areas would not fit into 64 bits.
constexpr int kMaxPictureSide = 1 << 18;

// Image coordinates in 1/256 pixel: x right, y down, (0, 0) the picture's upper left corner.
struct LatticePoint {
    int32_t x = 0;
    int32_t y = 0;

    constexpr auto operator<=>(const LatticePoint&) const = default;
    constexpr LatticePoint operator+(LatticePoint o) const { return {x + o.x, y + o.y}; }
    constexpr LatticePoint operator-(LatticePoint o) const { return {x - o.x, y - o.y}; }
};

inline glm::dvec2 toPixels(LatticePoint p) {
    return {double(p.x) / kLatticePerPixel, double(p.y) / kLatticePerPixel};
}

// The nearest lattice point.
inline LatticePoint toLattice(glm::dvec2 pixels) {
    return {int32_t(std::lround(pixels.x * kLatticePerPixel)),
            int32_t(std::lround(pixels.y * kLatticePerPixel))};
}

// The z component of a x b; positive where b lies on the inner side of a in a positively oriented triangle.
constexpr int64_t cross(LatticePoint a, LatticePoint b) {
    return int64_t(a.x) * b.y - int64_t(a.y) * b.x;
}

inline double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

// The unit vector in v's direction; 0 for 0.
inline glm::dvec2 unit(glm::dvec2 v) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y);
    return length > 0 ? v / length : glm::dvec2(0);
}

}  // namespace tessera
