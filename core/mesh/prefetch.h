// Asking for memory ahead of its use: the splines of a large mesh lie scattered, beyond the caches.
#pragma once

#include "core/mesh/tps.h"

namespace tessera {

inline void prefetch(const PatchSpline& spline) {
    constexpr size_t kLine = 64 / sizeof(float);
    __builtin_prefetch(spline.sites.data());
    for (size_t i = 0; i < spline.coefficients.size(); i += kLine)
        __builtin_prefetch(spline.coefficients.data() + i);
}

}  // namespace tessera
