// See edge_curves.h.
#include "core/vectorize/edge_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/parallel.h"

namespace tessera {

namespace {

constexpr uint32_t kNone = ~0U;
// Edges of the grid that a pixel owns: to the right, down, and diagonally to both.
constexpr std::array<glm::ivec2, 3> kEdge{glm::ivec2(1, 0), {0, 1}, {1, 1}};
// Variances of the stencils below: of the first derivatives, and of the second ones about.
constexpr double kFirstVariance = 1.0 / 3, kSecondVariance = 1.0 / 5;
// In the gradient's standard deviations under noise alone.
constexpr double kNoiseLow = 3.5, kNoiseHigh = 7;
// Steps in colour (Euclidean over the channels) that can be seen at all, and for sure.
constexpr double kContrastLow = 6.0 / 255, kContrastHigh = 12.0 / 255;
constexpr double kPeak = .3989422804014327;  // of the normal density
constexpr int kClaimPx = 2;
// For the finer of two scales: each change of scale along a curve costs a join.
constexpr double kPreference = 1.1;

}  // namespace

struct EdgeCurveFinder::Crossing {
    glm::dvec2 position;
    float magnitude = 0;
    bool blurred = false;
    float curvature = 0;  // sum over its links of the decrease of mAcross along the direction
    int links = 0;
    std::array<uint32_t, 2> next{kNone, kNone};
};

struct EdgeCurveFinder::Trace {
    std::vector<Crossing> crossings;
    bool closed = false;
};

EdgeCurveFinder::EdgeCurveFinder(const Image& image, std::stop_token stop)
    : mStop(std::move(stop)),
      mSmooth(image),
      mWhiteNoise(whiteNoise()),
      mSquare(image.planeSize()),
      mCoarserSquare(image.planeSize()),
      mDirection(image.planeSize()),
      mAcross(image.planeSize()),
      mIndex(image.planeSize() * 3, kNone),
      mTaken(image.planeSize(), 0) {}

double EdgeCurveFinder::totalVariance(double sigmaPx) {
    return smoothingVariance(sigmaPx) + 1.0 / 12;
}

double EdgeCurveFinder::smoothingVariance(double sigmaPx) {
    return sigmaPx * sigmaPx + 1.5 * kSecondVariance - .5 * kFirstVariance;
}

template <class Body>
void EdgeCurveFinder::forRows(Body&& body) const {
    constexpr size_t kGrain = 16;
    parallelFor(size_t(mSmooth.height()), kGrain, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end && !mStop.stop_requested(); ++y) body(int(y));
    });
}

std::vector<EdgeCurve> EdgeCurveFinder::find(double sigmaPx, double nextSigmaPx, double minLengthPx) {
    std::vector<EdgeCurve> curves;
    smoothTo(sigmaPx);
    gradients(mSquare, &mDirection);
    const double unit = kPeak / std::sqrt(totalVariance(sigmaPx)), noiseLevel = noise();
    const auto low = float(std::max(kNoiseLow * noiseLevel, kContrastLow * unit));
    const auto high = float(std::max(kNoiseHigh * noiseLevel, kContrastHigh * unit));
    if (mStop.stop_requested()) return curves;
    derivativesAcross(low * low);
    mBlurredRatio = 1e9F;  // which no ratio of gradients reaches
    mNoiseSquare = float(2 * noiseLevel * noiseLevel);
    if (nextSigmaPx > sigmaPx) {
        smoothTo(nextSigmaPx);
        gradients(mCoarserSquare, nullptr);
        mBlurredRatio = float(kPreference * std::sqrt(totalVariance(sigmaPx) / totalVariance(nextSigmaPx)));
    }
    if (mStop.stop_requested()) return curves;
    std::vector<Crossing> found = crossings(low * low);
    for (const int wantedLinks : {0, 1, 2})  // open curves from their ends, then closed ones
        for (uint32_t i = 0; i < found.size() && !mStop.stop_requested(); ++i)
            if (found[i].links == wantedLinks) keep(follow(found, i), high, minLengthPx, curves);
    for (const EdgeCurve& curve : curves) claim(curve);
    return curves;
}

void EdgeCurveFinder::smoothTo(double sigmaPx) {
    if (sigmaPx <= mSigma) return;
    const double more = std::sqrt(sigmaPx * sigmaPx - mSigma * mSigma);
    for (int c = 0; c < mSmooth.channels() && !mStop.stop_requested(); ++c) {
        cv::Mat plane(mSmooth.height(), mSmooth.width(), CV_32F, mSmooth.plane(c).data());
        cv::GaussianBlur(plane, plane, cv::Size(), more, more, cv::BORDER_REPLICATE);
    }
    mSigma = sigmaPx;
}

void EdgeCurveFinder::gradients(std::vector<float>& square, std::vector<glm::vec2>* direction) const {
    const int w = mSmooth.width(), h = mSmooth.height();
    forRows([&](int y) {
        std::vector<float> xx(size_t(w), 0.F), xy(xx), yy(xx);
        const int above = std::max(y - 1, 0), below = std::min(y + 1, h - 1);
        for (int c = 0; c < mSmooth.channels(); ++c) {
            const float* plane = mSmooth.plane(c).data();
            const float *a = plane + at(0, above), *m = plane + at(0, y), *b = plane + at(0, below);
            const auto add = [&](int x, int l, int r) {
                const float gx = (4 * (m[r] - m[l]) + (a[r] - a[l]) + (b[r] - b[l])) / 12;
                const float gy = (4 * (b[x] - a[x]) + (b[r] - a[r]) + (b[l] - a[l])) / 12;
                const auto i = size_t(x);
                xx[i] += gx * gx;
                xy[i] += gx * gy;
                yy[i] += gy * gy;
            };
            add(0, 0, std::min(1, w - 1));
            for (int x = 1; x + 1 < w; ++x) add(x, x - 1, x + 1);
            if (w > 1) add(w - 1, w - 2, w - 1);
        }
        for (int x = 0; x < w; ++x) {
            const auto i = size_t(x);
            const float half = .5F * (xx[i] - yy[i]), root = std::sqrt(half * half + xy[i] * xy[i]);
            square[at(x, y)] = .5F * (xx[i] + yy[i]) + root;
            if (!direction) continue;
            const glm::vec2 d = half >= 0 ? glm::vec2(half + root, xy[i]) : glm::vec2(xy[i], root - half);
            const float length = glm::length(d);
            (*direction)[at(x, y)] = length > 0 ? d / length : glm::vec2(1, 0);
        }
    });
}

// The least that `value` is in a block of the picture, but for the lowest few.
template <class Value>
double EdgeCurveFinder::quietest(Value&& value) const {
    constexpr int kBlockPx = 24;
    constexpr double kShare = .06;
    const int w = mSmooth.width(), h = mSmooth.height();
    const int columns = (w + kBlockPx - 1) / kBlockPx, rows = (h + kBlockPx - 1) / kBlockPx;
    std::vector<double> values(size_t(columns) * size_t(rows), 0);
    parallelFor(values.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end && !mStop.stop_requested(); ++i) {
            const int x0 = int(i % size_t(columns)) * kBlockPx, y0 = int(i / size_t(columns)) * kBlockPx;
            values[i] = value(x0, y0, std::min(x0 + kBlockPx, w), std::min(y0 + kBlockPx, h));
        }
    });
    const auto low = values.begin() + std::ptrdiff_t(kShare * double(values.size()));
    std::nth_element(values.begin(), low, values.end());
    return *low;
}

// The deviation of white noise, all channels together, by a difference that sees neither slopes nor edges
// along rows and columns (Immerkaer 1996).
double EdgeCurveFinder::whiteNoise() const {
    const Image& image = mSmooth;
    const int w = image.width(), h = image.height();
    if (w < 3 || h < 3) return 0;
    const double square = quietest([&](int x0, int y0, int x1, int y1) {
        double sum = 0;
        int count = 0;
        for (int c = 0; c < image.channels(); ++c)
            for (int y = std::max(y0, 1); y < std::min(y1, h - 1); y += 2)
                for (int x = std::max(x0, 1); x < std::min(x1, w - 1); ++x) {
                    const auto row = [&](int r) {
                        return image.at(x - 1, r, c) - 2 * image.at(x, r, c) + image.at(x + 1, r, c);
                    };
                    const float d = row(y - 1) - 2 * row(y) + row(y + 1);
                    sum += d * d / 36;
                    count += c == 0;
                }
        return sum / std::max(count, 1);
    });
    return std::sqrt(square);
}

// The scale of a Rayleigh distribution with the median that the gradients have where they are smallest: in a
// few of the picture's blocks there is nothing but noise. Where even those hold slopes, at most some times
// what white noise would give; noise of photographs is smoother than white.
double EdgeCurveFinder::noise() const {
    constexpr double kMostOfWhite = 2.5;
    const double median = quietest([&](int x0, int y0, int x1, int y1) {
        std::vector<float> block;
        for (int y = y0; y < y1; y += 2)
            for (int x = x0; x < x1; x += 2) block.push_back(mSquare[at(x, y)]);
        const auto middle = block.begin() + std::ptrdiff_t(block.size() / 2);
        std::nth_element(block.begin(), middle, block.end());
        return double(*middle);
    });
    const double white = mWhiteNoise / (std::sqrt(8 * std::acos(-1.0)) * smoothingVariance(mSigma));
    return std::min(std::sqrt(median / (2 * std::log(2.0))), kMostOfWhite * white);
}

// The second derivative along the gradient plus half of that along the edge, over the first: along a blurred
// circle of any radius, and along a straight edge, it is -distance / variance, so that its zero is where the
// edge was before it was blurred, and linear interpolation finds it.
void EdgeCurveFinder::derivativesAcross(float least) {
    const int w = mSmooth.width(), h = mSmooth.height();
    forRows([&](int y) {
        const int above = std::max(y - 1, 0), below = std::min(y + 1, h - 1);
        for (int x = 0; x < w; ++x) {
            const size_t i = at(x, y);
            if (mSquare[i] < least || mTaken[i]) continue;
            const int l = std::max(x - 1, 0), r = std::min(x + 1, w - 1);
            const glm::vec2 n = mDirection[i];
            float sum = 0;
            for (int c = 0; c < mSmooth.channels(); ++c) {
                const float* plane = mSmooth.plane(c).data();
                const float *a = plane + at(0, above), *m = plane + at(0, y), *b = plane + at(0, below);
                const float gx = (4 * (m[r] - m[l]) + (a[r] - a[l]) + (b[r] - b[l])) / 12;
                const float gy = (4 * (b[x] - a[x]) + (b[r] - a[r]) + (b[l] - a[l])) / 12;
                const float hxx =
                    (10 * (m[r] - 2 * m[x] + m[l]) + (a[r] - 2 * a[x] + a[l]) + (b[r] - 2 * b[x] + b[l])) /
                    12;
                const float hyy =
                    (10 * (b[x] - 2 * m[x] + a[x]) + (b[r] - 2 * m[r] + a[r]) + (b[l] - 2 * m[l] + a[l])) /
                    12;
                const float hxy = (b[r] - b[l] - a[r] + a[l]) / 4;
                const float along = n.x * n.x * hxx + 2 * n.x * n.y * hxy + n.y * n.y * hyy;
                sum += (n.x * gx + n.y * gy) * .5F * (along + hxx + hyy);
            }
            // Never zero, so that a vertex is on the same side of the level set as seen from all
            // triangles.
            mAcross[i] = sum != 0 ? sum / mSquare[i] : 1e-20F;
        }
    });
}

std::vector<EdgeCurveFinder::Crossing> EdgeCurveFinder::crossings(float least) {
    const int w = mSmooth.width(), h = mSmooth.height();
    const auto usable = [&](size_t i) { return mSquare[i] >= least && !mTaken[i]; };
    std::vector<Crossing> found;
    for (int y = 0; y < h && !mStop.stop_requested(); ++y)
        for (int x = 0; x < w; ++x) {
            const size_t p = at(x, y);
            std::fill_n(mIndex.begin() + std::ptrdiff_t(3 * p), 3, kNone);
            if (!usable(p)) continue;
            for (size_t e = 0; e < 3; ++e) {
                const int qx = x + kEdge[e].x, qy = y + kEdge[e].y;
                if (qx >= w || qy >= h || !usable(at(qx, qy))) continue;
                const size_t q = at(qx, qy);
                const float sign = glm::dot(mDirection[p], mDirection[q]) < 0 ? -1.F : 1.F;
                const float from = mAcross[p], to = sign * mAcross[q];
                if ((from < 0) == (to < 0)) continue;
                const double t = std::clamp(double(from) / (double(from) - to), .02, .98);
                mIndex[3 * p + e] = uint32_t(found.size());
                const double square = (1 - t) * mSquare[p] + t * mSquare[q];
                const double coarser = (1 - t) * mCoarserSquare[p] + t * mCoarserSquare[q];
                found.push_back({{x + .5 + t * kEdge[e].x, y + .5 + t * kEdge[e].y},
                                 float(std::sqrt(square)),
                                 coarser > mBlurredRatio * (square - 1.5 * mNoiseSquare)});
            }
        }
    for (int y = 0; y + 1 < h && !mStop.stop_requested(); ++y)
        for (int x = 0; x + 1 < w; ++x) {
            linkInTriangle(x, y, false, found);
            linkInTriangle(x, y, true, found);
        }
    return found;
}

// Links the two crossings of a triangle where the gradient has a maximum, not a minimum, between them.
void EdgeCurveFinder::linkInTriangle(int x, int y, bool upper, std::vector<Crossing>& found) const {
    const size_t a = at(x, y), b = upper ? at(x, y + 1) : at(x + 1, y), c = at(x + 1, y + 1);
    const std::array<uint32_t, 3> on{mIndex[3 * a + (upper ? 1 : 0)], mIndex[3 * b + (upper ? 0 : 1)],
                                     mIndex[3 * a + 2]};
    std::array<uint32_t, 2> pair{kNone, kNone};
    size_t count = 0;
    for (const uint32_t i : on)
        if (i != kNone && count++ < 2) pair[count - 1] = i;
    if (count != 2) return;
    const auto aligned = [&](size_t i) { return glm::dot(mDirection[a], mDirection[i]) < 0 ? -1.F : 1.F; };
    const float sb = aligned(b), sc = aligned(c);
    const float first = sb * mAcross[b] - mAcross[a], second = sc * mAcross[c] - sb * mAcross[b];
    const glm::vec2 slope = upper ? glm::vec2(second, first) : glm::vec2(first, second);
    const glm::vec2 direction = mDirection[a] + sb * mDirection[b] + sc * mDirection[c];
    const float decrease = -glm::dot(slope, direction) / std::max(glm::length(direction), 1e-6F);
    if (decrease <= 0) return;
    for (size_t k = 0; k < 2; ++k) {
        Crossing& crossing = found[pair[k]];
        crossing.next[size_t(crossing.links++)] = pair[1 - k];
        crossing.curvature += decrease;
    }
}

// The crossings of the curve from `start` on, which are then no longer linked.
EdgeCurveFinder::Trace EdgeCurveFinder::follow(std::vector<Crossing>& found, uint32_t start) {
    Trace trace;
    trace.closed = found[start].links == 2;
    for (uint32_t i = start; i != kNone;) {
        Crossing& here = found[i];
        trace.crossings.push_back(here);
        here.links = -1;
        i = kNone;
        for (const uint32_t n : here.next)
            if (n != kNone && found[n].links >= 0) {
                i = n;
                break;
            }
    }
    return trace;
}

// Which crossings belong to a stretch that the next scale shows better: by majority in a window, and no
// stretch is short.
std::vector<bool> EdgeCurveFinder::blurredStretches(const Trace& trace) {
    constexpr int kWindow = 12, kLeastStretch = 24;
    const auto n = int(trace.crossings.size());
    std::vector<int> sum(size_t(n) + 1, 0);
    for (int i = 0; i < n; ++i) sum[size_t(i) + 1] = sum[size_t(i)] + trace.crossings[size_t(i)].blurred;
    std::vector<bool> blurred(static_cast<size_t>(n));
    for (int i = 0; i < n; ++i) {
        const int from = std::max(i - kWindow, 0), to = std::min(i + kWindow + 1, n);
        blurred[size_t(i)] = 2 * (sum[size_t(to)] - sum[size_t(from)]) > to - from;
    }
    for (const bool value : {true, false})
        for (int i = 0; i < n;) {
            int j = i;
            while (j < n && blurred[size_t(j)] == blurred[size_t(i)]) ++j;
            const bool whole = i == 0 && j == n;
            if (blurred[size_t(i)] == value && j - i < kLeastStretch && !whole)
                std::fill(blurred.begin() + i, blurred.begin() + j, !value);
            i = j;
        }
    return blurred;
}

// Adds the parts of a trace that are sharp enough for this scale, strong in some places and long enough.
void EdgeCurveFinder::keep(const Trace& trace, float high, double minLengthPx,
                           std::vector<EdgeCurve>& curves) const {
    constexpr int kStrongPoints = 4;
    const std::vector<bool> blurred = blurredStretches(trace);
    EdgeCurve part;
    int strong = 0;
    double length = 0;
    const auto finish = [&] {
        if (strong >= kStrongPoints && length >= minLengthPx) curves.push_back(part);
        part = {};
        strong = 0, length = 0;
    };
    for (size_t i = 0; i < blurred.size(); ++i) {
        if (blurred[i]) {
            finish();
            continue;
        }
        const Crossing& here = trace.crossings[i];
        if (!part.points.empty()) length += glm::distance(part.points.back().position, here.position);
        part.points.push_back({here.position, here.links / std::max(double(here.curvature), 1e-3)});
        strong += here.magnitude >= high;
    }
    part.closed = trace.closed && part.points.size() == trace.crossings.size();
    finish();
}

void EdgeCurveFinder::claim(const EdgeCurve& curve) {
    for (const EdgeCurve::Point& p : curve.points) {
        const int x = int(p.position.x), y = int(p.position.y);
        for (int j = std::max(y - kClaimPx, 0); j <= std::min(y + kClaimPx, mSmooth.height() - 1); ++j)
            for (int i = std::max(x - kClaimPx, 0); i <= std::min(x + kClaimPx, mSmooth.width() - 1); ++i)
                mTaken[at(i, j)] = 1;
    }
}

}  // namespace tessera
