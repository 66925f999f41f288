// Quadric error metrics (Garland and Heckbert 1997) of several height fields over one plane: the sum over
// channels of the area-weighted squared distances to planes in (x, y, z_c).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tessera {

// One accumulated quadric for each of `count` vertices, over `channels` heights. The terms in x and y alone
// are common to the channels, so a vertex takes 6 + 4 channels numbers.
class QuadricArray {
  public:
    QuadricArray(size_t count, int channels)
        : mChannels(size_t(channels)), mStride(6 + 4 * mChannels), mData(count * mStride, 0.0) {}

    // A corner of a triangle: its place and its heights.
    struct Point {
        double x, y;
        const float* z;  // `channels` heights, multiplied by `scale`
    };

    // Adds the planes of one triangle, weighted by its area in each channel's space, to each of its corners'
    // quadrics.
    void addTriangle(const size_t corners[3], const Point points[3], double scale);

    // quadric[i] += quadric[j].
    void accumulate(size_t i, size_t j);

    // The error of vertex i's quadric at a point.
    double error(size_t i, const Point& at, double scale) const;

  private:
    // xx xy yy x y 1, then for each channel xz yz zz z.
    double* of(size_t i) { return mData.data() + i * mStride; }
    const double* of(size_t i) const { return mData.data() + i * mStride; }

    size_t mChannels;
    size_t mStride;
    std::vector<double> mData;
};

}  // namespace tessera
