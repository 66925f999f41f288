// G1 continuity where two feature curves meet (paper section 4.2): "control points may be slightly adjusted".
#pragma once

#include <stop_token>

#include "core/vectorize/simplify.h"

namespace tessera {

// Gives the two curves of a feature one tangent at each vertex inside it where they turn by less than
// settings.cornerDegrees. Where a patch has both curves as sides, det J would vanish at the vertex: then the
// patch's third side is flipped first, and where it cannot be, the join stays as it is. So it does where a
// curve would leave its polyline by more than settings.curveTolerancePx or a patch would lose its
// certificate. Records the joins in the mesh, and their number in the report. Leaves the rest undone where
// `stop` is asked for.
void smoothJoins(BaseDomain& base, const VectorizeSettings& settings, StageReport& report,
                 const std::stop_token& stop = {});

}  // namespace tessera
