// See quadric.h.
#include "core/mesh/quadric.h"

#include <cmath>

namespace tessera {

void QuadricArray::addTriangle(const size_t corners[3], const Point p[3], double scale) {
    const double ax = p[1].x - p[0].x, ay = p[1].y - p[0].y, bx = p[2].x - p[0].x, by = p[2].y - p[0].y;
    double planar[6] = {};
    double vertical[4 * 4] = {};
    for (size_t c = 0; c < mChannels; ++c) {
        const double z0 = scale * double(p[0].z[c]);
        const double az = scale * double(p[1].z[c]) - z0, bz = scale * double(p[2].z[c]) - z0;
        // The normal's length is twice the area: weight n n^T / |n|^2 by |n| / 2.
        const double nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
        const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
        if (length <= 0) continue;
        const double weight = .5 / length;
        const double d = -(nx * p[0].x + ny * p[0].y + nz * z0);
        planar[0] += weight * nx * nx;
        planar[1] += weight * nx * ny;
        planar[2] += weight * ny * ny;
        planar[3] += weight * nx * d;
        planar[4] += weight * ny * d;
        planar[5] += weight * d * d;
        vertical[4 * c] = weight * nx * nz;
        vertical[4 * c + 1] = weight * ny * nz;
        vertical[4 * c + 2] = weight * nz * nz;
        vertical[4 * c + 3] = weight * nz * d;
    }
    for (int k = 0; k < 3; ++k) {
        double* q = of(corners[k]);
        for (size_t i = 0; i < 6; ++i) q[i] += planar[i];
        for (size_t i = 0; i < 4 * mChannels; ++i) q[6 + i] += vertical[i];
    }
}

void QuadricArray::accumulate(size_t i, size_t j) {
    double* to = of(i);
    const double* from = of(j);
    for (size_t k = 0; k < mStride; ++k) to[k] += from[k];
}

double QuadricArray::error(size_t i, const Point& at, double scale) const {
    const double* q = of(i);
    const double x = at.x, y = at.y;
    double sum = x * (q[0] * x + 2 * (q[1] * y + q[3])) + y * (q[2] * y + 2 * q[4]) + q[5];
    for (size_t c = 0; c < mChannels; ++c) {
        const double* v = q + 6 + 4 * c;
        const double z = scale * double(at.z[c]);
        sum += z * (2 * (v[0] * x + v[1] * y + v[3]) + v[2] * z);
    }
    return sum > 0 ? sum : 0;
}

}  // namespace tessera
