// Counts up to a multiple: of lanes, of a tile, of a page.
#pragma once

namespace tessera {

// The least multiple of `step` (> 0) that is at least `count` (>= 0).
template <class T>
constexpr T roundUp(T count, T step) {
    return (count + step - 1) / step * step;
}

}  // namespace tessera
