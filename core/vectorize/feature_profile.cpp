// See feature_profile.h.
#include "core/vectorize/feature_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/base/parallel.h"
#include "core/mesh/lattice.h"

namespace tessera {

namespace {

constexpr double kBoxVariance = 1.0 / 12;  // of a pixel's square, in px^2
constexpr double kReachSigmas = 2.6, kLeastReachPx = 1.6, kMostReachPx = 9;
constexpr double kStripPx = 1.5;  // half the width of the strip across the chain that a point looks at
constexpr uint32_t kFree = ~0U;

// The normal distribution and its density, by table: exact to 1e-5.
class Normal {
  public:
    Normal() {
        for (size_t i = 0; i < kCount; ++i) {
            const double x = (double(i) - kHalf) / kPerUnit;
            mPhi[i] = float(.5 * std::erfc(-x * .70710678118654752440));
            mDensity[i] = float(.3989422804014327 * std::exp(-.5 * x * x));
        }
    }
    float phi(float x) const { return at(mPhi, x); }
    float density(float x) const { return at(mDensity, x); }

  private:
    static constexpr int kPerUnit = 64, kHalf = 5 * kPerUnit;
    static constexpr size_t kCount = 2 * kHalf + 2;
    static float at(const std::array<float, kCount>& table, float x) {
        const float place = std::clamp(x * kPerUnit + kHalf, 0.F, float(2 * kHalf));
        const auto i = size_t(place);
        const float f = place - float(i);
        return table[i] + f * (table[i + 1] - table[i]);
    }
    std::array<float, kCount> mPhi{}, mDensity{};
};

// Whose point lies in each pixel: points counted through all chains.
class Owners {
  public:
    Owners(const std::vector<FeatureChain>& chains, int width, int height)
        : mWidth(width), mHeight(height), mOwner(size_t(width) * size_t(height), kFree) {
        uint32_t next = 0;
        for (const FeatureChain& chain : chains)
            for (const FeaturePoint& p : chain.points) {
                if (const auto i = index(p.position); i < mOwner.size()) mOwner[i] = next;
                ++next;
            }
    }
    // Half the distance from `p` along `direction` to the next point that is not within kNear of point
    // `self` of its own chain, which are [first, first + count); at most `most`.
    double freeReach(glm::dvec2 p, glm::dvec2 direction, double most, uint32_t self, uint32_t first,
                     uint32_t count) const {
        constexpr uint32_t kNear = 6;
        for (double d = 1; d < 2 * most; d += .7) {
            const size_t i = index(p + d * direction);
            if (i >= mOwner.size()) break;
            const uint32_t other = mOwner[i];
            if (other == kFree) continue;
            const uint32_t apart = other > self ? other - self : self - other;
            const bool own = other >= first && other < first + count;
            if (own && (apart <= kNear || apart + kNear >= count)) continue;
            return std::max(.5 * d, 1.0);
        }
        return most;
    }

  private:
    size_t index(glm::dvec2 p) const {
        const int x = int(std::floor(p.x)), y = int(std::floor(p.y));
        if (x < 0 || y < 0 || x >= mWidth || y >= mHeight) return mOwner.size();
        return size_t(y) * size_t(mWidth) + size_t(x);
    }
    int mWidth, mHeight;
    std::vector<uint32_t> mOwner;
};

// One pixel beside a point of a chain.
struct Sample {
    float distance;  // signed, along the normal
    float weight;
    std::array<float, kMaxChannels> colour;
};

struct Frame {
    glm::dvec2 at, normal;
    double curvature;  // positive where the chain turns toward the normal
    double reach[2];   // on the negative and on the positive side
};

size_t neighbour(const FeatureChain& chain, size_t i, int step) {
    const auto n = int(chain.points.size());
    const int j = int(i) + step;
    return size_t(chain.closed ? ((j % n) + n) % n : std::clamp(j, 0, n - 1));
}

Frame frameAt(const FeatureChain& chain, size_t i) {
    const glm::dvec2 here = chain.points[i].position, before = chain.points[neighbour(chain, i, -3)].position,
                     after = chain.points[neighbour(chain, i, 3)].position;
    const glm::dvec2 along = after - before;
    const double length = glm::length(along);
    if (length <= 0) return {here, {0, 1}, 0, {0, 0}};
    Frame frame{here, glm::dvec2(-along.y, along.x) / length, 0, {0, 0}};
    const double a = glm::distance(before, here), b = glm::distance(here, after);
    if (a > .5 && b > .5) frame.curvature = 2 * cross(here - before, after - here) / (a * b * length);
    frame.curvature = std::clamp(frame.curvature, -.5, .5);
    return frame;
}

void collect(const Image& image, const Frame& frame, std::vector<Sample>& samples) {
    samples.clear();
    const double most = std::max(frame.reach[0], frame.reach[1]);
    const double extentX = std::abs(frame.normal.x) * most + std::abs(frame.normal.y) * kStripPx,
                 extentY = std::abs(frame.normal.y) * most + std::abs(frame.normal.x) * kStripPx;
    const int x0 = std::max(int(frame.at.x - extentX), 0), y0 = std::max(int(frame.at.y - extentY), 0);
    const int x1 = std::min(int(frame.at.x + extentX), image.width() - 1),
              y1 = std::min(int(frame.at.y + extentY), image.height() - 1);
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const glm::dvec2 step = glm::dvec2(x + .5, y + .5) - frame.at;
            const double u = cross(step, frame.normal);
            if (std::abs(u) > kStripPx) continue;
            const double d = glm::dot(step, frame.normal) - .5 * frame.curvature * u * u;
            if (d < -frame.reach[0] || d > frame.reach[1]) continue;
            Sample s{float(d), float(1 - .5 * std::abs(u) / kStripPx), {}};
            for (int c = 0; c < image.channels(); ++c) s.colour[size_t(c)] = image.at(x, y, c);
            samples.push_back(s);
        }
}

// The colours on the negative side and the jumps, given the deviation of the blurred step.
struct Step {
    std::array<float, kMaxChannels> base{}, jump{};
    float contrast = 0;
};

Step fitStep(const std::vector<Sample>& samples, int channels, float deviation, float shift,
             const Normal& normal) {
    double w = 0, wp = 0, wpp = 0;
    std::array<double, kMaxChannels> v{}, vp{};
    for (const Sample& s : samples) {
        const double p = normal.phi((s.distance - shift) / deviation);
        w += s.weight;
        wp += s.weight * p;
        wpp += s.weight * p * p;
        for (size_t c = 0; c < size_t(channels); ++c) {
            v[c] += double(s.weight) * s.colour[c];
            vp[c] += s.weight * p * s.colour[c];
        }
    }
    Step step;
    // Extrapolation from few pixels can give colours that no picture has.
    float brightest = 1;
    for (const Sample& s : samples) brightest = std::max(brightest, std::ranges::max(s.colour));
    const double det = w * wpp - wp * wp;
    if (det <= 1e-3 * w * w) return step;
    for (size_t c = 0; c < size_t(channels); ++c) {
        step.base[c] = float((wpp * v[c] - wp * vp[c]) / det);
        step.jump[c] = std::clamp(float((w * vp[c] - wp * v[c]) / det), -brightest, brightest);
        step.contrast += step.jump[c] * step.jump[c];
    }
    step.contrast = std::sqrt(step.contrast);
    return step;
}

// A step of Gauss and Newton on the place and the logarithm of the deviation; returns the factor to the
// latter. The place is fitted too only so that an error of it does not look like blur.
float improve(const std::vector<Sample>& samples, int channels, const Step& step, float deviation,
              float& shift, const Normal& normal) {
    double aa = 0, ab = 0, bb = 0, ar = 0, br = 0;
    for (const Sample& s : samples) {
        const float x = (s.distance - shift) / deviation;
        const float p = normal.phi(x), slope = normal.density(x) * step.contrast;
        float residual = 0;
        for (size_t c = 0; c < size_t(channels); ++c)
            residual += step.jump[c] * (s.colour[c] - step.base[c] - step.jump[c] * p);
        residual /= step.contrast;
        const double a = -slope / deviation, b = -slope * x;
        aa += s.weight * a * a;
        ab += s.weight * a * b;
        bb += s.weight * b * b;
        ar += s.weight * a * residual;
        br += s.weight * b * residual;
    }
    const double damp = .02 * (aa + bb) + 1e-12, det = (aa + damp) * (bb + damp) - ab * ab;
    if (det <= 0) return 1;
    shift = float(std::clamp(shift + ((bb + damp) * ar - ab * br) / det, -.4, .4));
    return float(std::exp(std::clamp(((aa + damp) * br - ab * ar) / det, -.4, .4)));
}

class ProfileFit {
  public:
    ProfileFit(const Image& image, const std::vector<FeatureChain>& chains)
        : mImage(image), mOwners(chains, image.width(), image.height()) {}

    void fit(FeatureChain& chain, uint32_t first) const {
        const size_t n = chain.points.size();
        std::vector<Frame> frames(n);
        std::vector<Sample> samples;
        std::vector<float> logs(n), weights(n);
        for (size_t i = 0; i < n; ++i) {
            frames[i] = frameAt(chain, i);
            setReach(frames[i], chain, i, first);
        }
        // The smoothing below makes up for every other point, which looks at nearly the same pixels.
        for (size_t i = 0; i < n; i += 2) {
            collect(mImage, frames[i], samples);
            logs[i] = std::log(fitDeviation(samples, chain.points[i].sigma, weights[i]));
        }
        for (size_t i = 1; i < n; i += 2) {
            const size_t next = i + 1 < n ? i + 1 : i - 1;
            logs[i] = .5F * (logs[i - 1] + logs[next]);
            weights[i] = .5F * (weights[i - 1] + weights[next]);
        }
        const std::vector<float> smooth = smoothed(chain, logs, weights);
        for (size_t i = 0; i < n; ++i) setPoint(chain.points[i], frames[i], std::exp(smooth[i]), samples);
        smoothJumps(chain);
    }

  private:
    static float least() { return std::hypot(kLeastBlurPx, float(std::sqrt(kBoxVariance))); }
    static float most() { return std::hypot(kMostBlurPx, float(std::sqrt(kBoxVariance))); }

    // Of blur and pixel together; weight is the square of the step's contrast.
    float fitDeviation(std::vector<Sample>& samples, float sigma, float& weight) const {
        constexpr int kRounds = 4;
        float deviation = std::hypot(sigma, float(std::sqrt(kBoxVariance))), shift = 0;
        for (int round = 0; round < kRounds; ++round) {
            const Step step = fitStep(samples, mImage.channels(), deviation, shift, mNormal);
            if (step.contrast <= 0) break;
            weight = step.contrast * step.contrast;
            const float factor = improve(samples, mImage.channels(), step, deviation, shift, mNormal);
            deviation = std::clamp(deviation * factor, least(), most());
            if (std::abs(factor - 1) < .01F) break;
        }
        return deviation;
    }

    void setReach(Frame& frame, const FeatureChain& chain, size_t i, uint32_t first) const {
        const double wanted = std::clamp(kReachSigmas * std::hypot(double(chain.points[i].sigma), .3),
                                         kLeastReachPx, kMostReachPx);
        for (const int side : {0, 1})
            frame.reach[side] = mOwners.freeReach(frame.at, side ? frame.normal : -frame.normal, wanted,
                                                  first + uint32_t(i), first, uint32_t(chain.points.size()));
    }

    // Weighted median over a window, then the weighted mean.
    static std::vector<float> smoothed(const FeatureChain& chain, const std::vector<float>& values,
                                       const std::vector<float>& weights) {
        constexpr int kHalf = 4;
        std::vector<float> median(values.size()), result(values.size());
        for (size_t i = 0; i < values.size(); ++i) {
            std::array<float, 2 * kHalf + 1> window{};
            for (int k = -kHalf; k <= kHalf; ++k) window[size_t(k + kHalf)] = values[neighbour(chain, i, k)];
            std::nth_element(window.begin(), window.begin() + kHalf, window.end());
            median[i] = window[kHalf];
        }
        for (size_t i = 0; i < values.size(); ++i) {
            float sum = 0, weight = 0;
            for (int k = -kHalf; k <= kHalf; ++k) {
                const size_t j = neighbour(chain, i, k);
                // A value far from the median is an outlier that counts as if it were nearer.
                const float value = std::clamp(values[j], median[j] - .3F, median[j] + .3F);
                sum += (weights[j] + 1e-6F) * value;
                weight += weights[j] + 1e-6F;
            }
            result[i] = sum / weight;
        }
        return result;
    }

    void setPoint(FeaturePoint& p, const Frame& frame, float deviation, std::vector<Sample>& samples) const {
        collect(mImage, frame, samples);
        const Step step = fitStep(samples, mImage.channels(), deviation, 0, mNormal);
        p.sigma = std::clamp(std::sqrt(std::max(deviation * deviation - float(kBoxVariance), 0.F)),
                             kLeastBlurPx, kMostBlurPx);
        p.jump = step.jump;
    }

    static void smoothJumps(FeatureChain& chain) {
        std::vector<std::array<float, kMaxChannels>> jumps;
        for (const FeaturePoint& p : chain.points) jumps.push_back(p.jump);
        for (size_t i = 0; i < jumps.size(); ++i) {
            FeaturePoint& p = chain.points[i];
            float square = 0;
            for (size_t c = 0; c < kMaxChannels; ++c) {
                p.jump[c] = .5F * jumps[i][c] +
                            .25F * (jumps[neighbour(chain, i, -1)][c] + jumps[neighbour(chain, i, 1)][c]);
                square += p.jump[c] * p.jump[c];
            }
            p.contrast = std::sqrt(square);
        }
    }

    const Image& mImage;
    Owners mOwners;
    Normal mNormal;
};

}  // namespace

void fitProfiles(const Image& image, std::vector<FeatureChain>& chains, const std::stop_token& stop) {
    std::vector<uint32_t> first;
    uint32_t count = 0;
    for (const FeatureChain& chain : chains) {
        first.push_back(count);
        count += uint32_t(chain.points.size());
    }
    const ProfileFit profiles(image, chains);
    parallelFor(chains.size(), 8, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end && !stop.stop_requested(); ++i) profiles.fit(chains[i], first[i]);
    });
}

}  // namespace tessera
