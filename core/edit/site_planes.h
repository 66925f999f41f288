// Values at all sites of a spline's domain, in planes of whole vectors.
#pragma once

#include <array>
#include <cstring>
#include <vector>

#include "core/base/vectors.h"
#include "core/edit/colour_samples.h"
#include "core/mesh/tps.h"

namespace tessera {

// A value for each site, filled up with zeros.
constexpr size_t kSitePlane = 160;
using SitePlane = std::array<float, kSitePlane>;
using SitePlanes = std::array<SitePlane, kMaxChannels>;

// The sites in their order, as points of the domain.
struct SitePoints {
    std::vector<Barycentric> barycentrics;
    DomainPoints domain;
    std::array<SitePlane, 3> planes{};  // the barycentric coordinates
    // In a fit: 4 for those on a side against 1 in the middle, since neighbours must agree there.
    SitePlane weights{};
    double weight = 0;  // of all
};
const SitePoints& sitePoints();

inline std::array<float*, kMaxChannels> pointersTo(SitePlanes& planes) {
    std::array<float*, kMaxChannels> pointers;
    for (size_t c = 0; c < kMaxChannels; ++c) pointers[c] = planes[c].data();
    return pointers;
}

// The sum of products; the same bits with all vector instructions.
TESSERA_INLINE double siteProduct(const SitePlane& a, const SitePlane& b) {
    constexpr size_t kLanes = 8;
    Vector<float, kLanes> sum{};
    for (size_t i = 0; i < kSitePlane; i += kLanes) {
        Vector<float, kLanes> x, y;
        std::memcpy(&x, a.data() + i, sizeof x);
        std::memcpy(&y, b.data() + i, sizeof y);
        sum += x * y;
    }
    return (double(sum[0]) + double(sum[4]) + (double(sum[1]) + double(sum[5]))) +
           (double(sum[2]) + double(sum[6]) + (double(sum[3]) + double(sum[7])));
}

}  // namespace tessera
