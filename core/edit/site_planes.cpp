// See site_planes.h.
#include "core/edit/site_planes.h"

#include <algorithm>

namespace tessera {

const SitePoints& sitePoints() {
    static const SitePoints points = [] {
        constexpr float kOnSide = 4;
        SitePoints all;
        for (const glm::dvec2& site : centreSites()) {
            const Barycentric b = barycentricOf(site);
            const size_t i = all.barycentrics.size();
            all.barycentrics.push_back(b);
            for (int k = 0; k < 3; ++k) all.planes[size_t(k)][i] = float(b[k]);
            all.weights[i] = std::min({b.x, b.y, b.z}) < 1e-9 ? kOnSide : 1;
            all.weight += double(all.weights[i]);
        }
        all.domain = DomainPoints(all.barycentrics);
        return all;
    }();
    return points;
}

}  // namespace tessera
