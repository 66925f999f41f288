// Curves of edges at one scale: where the gradient of the smoothed picture is largest along its own direction
// (Canny 1986, Di Zenzo 1986, Lindeberg 1998), as level sets on the triangulated grid, which cannot branch.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <stop_token>
#include <vector>

#include "core/image/image.h"

namespace tessera {

struct EdgeCurve {
    struct Point {
        glm::dvec2 position;
        double variance;  // px^2, of the Gaussian that blurs the step in the smoothed picture
    };
    std::vector<Point> points;  // a closed curve does not repeat its first
    bool closed = false;
};

// Finds the curves of a picture scale by scale. Keeps the picture's copy smoothed up to the scale asked for
// last, so that scales must grow.
class EdgeCurveFinder {
  public:
    // Where `stop` is asked for, this and find() end early, with curves missing.
    EdgeCurveFinder(const Image& image, std::stop_token stop);

    // Curves at least minLengthPx long, in a fixed order, that keep 2 px away from those of the scales before
    // and are not so blurred that the scale to come next shows them better (Lindeberg's normalized gradient;
    // nextSigmaPx is 0 where none comes). A gradient counts above what noise gives (from the gradients' own
    // distribution) and above what a step of visible contrast gives.
    std::vector<EdgeCurve> find(double sigmaPx, double nextSigmaPx, double minLengthPx);

    // The square of the gradient's magnitude at each pixel, in colour units a px, at the scale asked for
    // last.
    const std::vector<float>& squaredGradient() const { return mSquare; }

    // Variance, in px^2, of all smoothing before a curve's variance is measured but for the picture's own.
    static double smoothingVariance(double sigmaPx);

  private:
    struct Crossing;
    struct Trace;

    static double totalVariance(double sigmaPx);
    // Calls body(y) for the rows of the picture, on all threads, as long as there is no stop.
    template <class Body>
    void forRows(Body&& body) const;
    void smoothTo(double sigmaPx);
    void gradients(std::vector<float>& square, std::vector<glm::vec2>* direction) const;
    template <class Value>
    double quietest(Value&& value) const;
    double whiteNoise() const;
    double noise() const;
    void derivativesAcross(float least);
    std::vector<Crossing> crossings(float least);
    void linkInTriangle(int x, int y, bool upper, std::vector<Crossing>& found) const;
    static Trace follow(std::vector<Crossing>& found, uint32_t start);
    static std::vector<bool> blurredStretches(const Trace& trace);
    void keep(const Trace& trace, float high, double minLengthPx, std::vector<EdgeCurve>& curves) const;
    void claim(const EdgeCurve& curve);
    size_t at(int x, int y) const { return size_t(y) * size_t(mSmooth.width()) + size_t(x); }

    std::stop_token mStop;
    Image mSmooth;
    double mWhiteNoise;  // deviation in the picture itself
    double mSigma = 0;
    std::vector<float> mSquare;         // of the gradient's magnitude
    std::vector<float> mCoarserSquare;  // the same at the next scale
    float mBlurredRatio = 0;            // of the two, above which the next scale is better
    float mNoiseSquare = 0;             // what noise adds to mSquare
    std::vector<glm::vec2> mDirection;  // of unit length; its sign means nothing
    std::vector<float> mAcross;         // second derivative over first, along mDirection
    std::vector<uint32_t> mIndex;       // of the crossing on each of a pixel's three edges
    std::vector<uint8_t> mTaken;        // by curves of the scales before
};

}  // namespace tessera
