// See colour_fan.h.
#include "core/edit/colour_fan.h"

namespace tessera {

bool separatesColours(const PatchMesh& mesh, HalfedgeId h) {
    const EdgeCurve& curve = mesh.curve(HalfedgeMesh::edge(h));
    return curve.feature || curve.colourBreak;
}

std::vector<HalfedgeId> fanOf(const PatchMesh& mesh, HalfedgeId side) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<HalfedgeId> fan{side};
    // Over the side that enters the vertex, patch after patch.
    for (HalfedgeId h = side;;) {
        const HalfedgeId entering = c.prev(h);
        h = HalfedgeMesh::twin(entering);
        if (separatesColours(mesh, entering) || !c.face(h).valid()) break;
        if (h == side) return fan;
        fan.push_back(h);
    }
    for (HalfedgeId h = side;;) {
        const HalfedgeId beyond = HalfedgeMesh::twin(h);
        if (separatesColours(mesh, h) || !c.face(beyond).valid()) break;
        h = c.next(beyond);
        fan.push_back(h);
    }
    return fan;
}

PatchSpline withCornersRaised(PatchSpline spline, ColourBasis basis, CornerValues values) {
    float* planes[3] = {values[0].data(), values[1].data(), values[2].data()};
    fromWorking(basis, planes, 3);
    constexpr double kSlope = .5 / kDomainHeight;
    for (int c = 0; c < 3; ++c) {
        const auto& [a, b, w] = values[size_t(c)];
        float* k = spline.coefficients.data() + spline.offset(c);
        k[0] += a;
        k[1] += b - a;
        k[2] += float(double(w) / kDomainHeight - kSlope * (double(a) + double(b)));
    }
    return spline;
}

}  // namespace tessera
