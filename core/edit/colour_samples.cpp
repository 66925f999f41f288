// See colour_samples.h.
#include "core/edit/colour_samples.h"

#include <algorithm>

namespace tessera {

DomainPoints::DomainPoints(std::span<const Barycentric> points) {
    for (const Barycentric& b : points) {
        const glm::dvec2 at = domainPoint(b);
        x.push_back(float(at.x));
        y.push_back(float(at.y));
    }
}

std::vector<ColourSample> sampleColours(const PatchMesh& mesh, PatchId p, const DomainPoints& points) {
    const size_t n = points.size();
    std::vector<float> values(n * kMaxChannels);
    float* planes[kMaxChannels];
    for (size_t c = 0; c < kMaxChannels; ++c) planes[c] = values.data() + c * n;
    evaluateSplines(mesh.spline(p), mesh.channels(), points.x.data(), points.y.data(), n, planes);
    toWorking(mesh.colourBasis(), planes, n);
    std::vector<ColourSample> samples(n);
    for (size_t i = 0; i < n; ++i) {
        samples[i].srgb = {double(planes[0][i]), double(planes[1][i]), double(planes[2][i])};
        if (mesh.channels() <= 3) continue;
        samples[i].alpha = double(planes[3][i]);
        samples[i].srgb /= std::max(samples[i].alpha, kLeastAlpha);
    }
    return samples;
}

ColourSample sampleColour(const PatchMesh& mesh, PatchId p, const Barycentric& at) {
    return sampleColours(mesh, p, DomainPoints(std::span(&at, 1))).front();
}

std::vector<Barycentric> latticeOf(int n) {
    std::vector<Barycentric> points;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i + j <= n; ++i)
            points.emplace_back(double(n - i - j) / n, double(i) / n, double(j) / n);
    return points;
}

}  // namespace tessera
