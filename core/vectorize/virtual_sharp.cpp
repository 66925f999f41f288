// See virtual_sharp.h.
#include "core/vectorize/virtual_sharp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/mesh/blur_profile.h"

namespace tessera {

namespace {

constexpr int kBandRows = 16;
constexpr uint32_t kNone = ~0U;

// A point of a curve with what holds there.
struct Knot {
    glm::dvec2 position;
    glm::dvec2 normal;  // unit; at a corner it halves the angle
    float deviation;    // of the blur and a pixel's square together
    float fade;
    std::array<float, kMaxChannels> jump;
};

// The curves of a chain as a fine polyline.
struct Strand {
    std::vector<Knot> knots;  // a closed one repeats its first
    double top = 0, bottom = 0;
    float reach = 0;
};

Knot knotAt(const FeatureChain& chain, glm::dvec2 position, double index) {
    const size_t n = chain.points.size();
    const size_t i = size_t(index) % n, j = chain.closed ? (i + 1) % n : std::min(i + 1, n - 1);
    const auto t = float(index - std::floor(index));
    const FeaturePoint &a = chain.points[i], &b = chain.points[j];
    Knot knot{position, {}, std::hypot((1 - t) * a.sigma + t * b.sigma, std::sqrt(1.F / 12)), 1, {}};
    for (size_t c = 0; c < kMaxChannels; ++c) knot.jump[c] = (1 - t) * a.jump[c] + t * b.jump[c];
    return knot;
}

void appendCurve(const FeatureNetwork& network, const FeatureSegment& s, Strand& strand) {
    constexpr double kPiecePx = .7;
    const FeatureChain& chain = network.chains[s.chain];
    const BezierCurve curve = curveOf(network, s);
    const size_t n = chain.points.size();
    const size_t steps = s.last > s.first ? s.last - s.first : s.last + n - s.first;
    const int pieces = std::max(int(std::ceil(curve.length() / kPiecePx)), 1);
    double index = 0;
    for (int k = strand.knots.empty() ? 0 : 1; k <= pieces; ++k) {
        const glm::dvec2 p = curve.at(double(k) / pieces);
        // The nearest place of the chain's polyline from the last one on.
        const auto at = [&](double i) { return chain.points[(s.first + size_t(i)) % n].position; };
        while (index + 1 <= double(steps) && glm::distance(at(index + 1), p) < glm::distance(at(index), p))
            ++index;
        double place = index;
        if (index < double(steps)) {
            const glm::dvec2 d = at(index + 1) - at(index);
            place += std::clamp(glm::dot(p - at(index), d) / std::max(glm::dot(d, d), 1e-12), 0.0, .999);
        }
        strand.knots.push_back(knotAt(chain, p, std::fmod(s.first + place, double(n))));
    }
}

void finish(const FeatureNetwork& network, const FeatureChain& chain, Strand& strand) {
    auto& knots = strand.knots;
    const size_t n = knots.size();
    std::vector<double> arc(n, 0);
    for (size_t i = 1; i < n; ++i)
        arc[i] = arc[i - 1] + glm::distance(knots[i - 1].position, knots[i].position);
    const auto along = [&](size_t i) {  // of the piece from knot i on
        const glm::dvec2 d = knots[i + 1].position - knots[i].position;
        return d / std::max(glm::length(d), 1e-12);
    };
    strand.top = network.height;
    for (size_t i = 0; i < n; ++i) {
        Knot& knot = knots[i];
        const glm::dvec2 before = along(i > 0          ? i - 1
                                        : chain.closed ? n - 2
                                                       : 0),
                         after = along(i + 1 < n      ? i
                                       : chain.closed ? 0
                                                      : n - 2);
        const glm::dvec2 d = before + after;
        knot.normal = glm::dvec2(-d.y, d.x) / std::max(glm::length(d), 1e-12);
        if (!chain.closed && chain.ends[0] != ChainEnd::Border)
            knot.fade *= float(blurFade(arc[i], knot.deviation));
        if (!chain.closed && chain.ends[1] != ChainEnd::Border)
            knot.fade *= float(blurFade(arc.back() - arc[i], knot.deviation));
        strand.reach = std::max(strand.reach, float(kBlurReach) * knot.deviation);
        strand.top = std::min(strand.top, knot.position.y);
        strand.bottom = std::max(strand.bottom, knot.position.y);
    }
}

std::vector<Strand> strandsOf(const FeatureNetwork& network) {
    std::vector<Strand> strands(network.chains.size());
    for (const FeatureSegment& s : network.segments) appendCurve(network, s, strands[s.chain]);
    for (size_t c = 0; c < strands.size(); ++c)
        if (strands[c].knots.size() >= 2) finish(network, network.chains[c], strands[c]);
    return strands;
}

// The rows [top, top + rows) of the picture, one strand after the other.
class Band {
  public:
    Band(Image& image, int perSide, int top)
        : mImage(image),
          mPerSide(perSide),
          mTop(top),
          mRows(std::min(kBandRows, image.height() - top)),
          mNearest(size_t(image.width()) * size_t(mRows)) {}

    void apply(const Strand& strand) {
        const double reach = double(strand.reach);
        if ((strand.top - reach) * mPerSide > mTop + mRows || (strand.bottom + reach) * mPerSide < mTop)
            return;
        for (uint32_t i = 0; i + 1 < strand.knots.size(); ++i) visit(strand, i);
        for (const uint32_t pixel : mTouched) sharpen(strand, pixel);
        mTouched.clear();
    }

  private:
    struct Nearest {
        uint32_t piece = kNone;
        float square = 0, t = 0;
    };

    // Of a pixel of mImage, in px of the picture.
    glm::dvec2 centre(int x, int y) const { return glm::dvec2(x + .5, y + .5) / double(mPerSide); }

    void visit(const Strand& strand, uint32_t piece) {
        const Knot &a = strand.knots[piece], &b = strand.knots[piece + 1];
        const double reach = kBlurReach * std::max(a.deviation, b.deviation);
        const glm::dvec2 low = (glm::min(a.position, b.position) - reach) * double(mPerSide) - .5,
                         d = b.position - a.position,
                         high = (glm::max(a.position, b.position) + reach) * double(mPerSide) - .5;
        const int x0 = std::max(int(std::ceil(low.x)), 0), x1 = std::min(int(high.x), mImage.width() - 1);
        const int y0 = std::max(int(std::ceil(low.y)), mTop), y1 = std::min(int(high.y), mTop + mRows - 1);
        const double dd = std::max(glm::dot(d, d), 1e-12);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const glm::dvec2 r = centre(x, y) - a.position;
                const double t = std::clamp(glm::dot(r, d) / dd, 0.0, 1.0);
                const glm::dvec2 off = r - t * d;
                const auto square = float(glm::dot(off, off));
                const auto pixel = uint32_t((y - mTop) * mImage.width() + x);
                Nearest& nearest = mNearest[pixel];
                if (nearest.piece == kNone) mTouched.push_back(pixel);
                if (nearest.piece == kNone || square < nearest.square) nearest = {piece, square, float(t)};
            }
    }

    void sharpen(const Strand& strand, uint32_t pixel) {
        const Nearest nearest = mNearest[pixel];
        mNearest[pixel] = {};
        const Knot &a = strand.knots[nearest.piece], &b = strand.knots[nearest.piece + 1];
        const float t = nearest.t, deviation = a.deviation + t * (b.deviation - a.deviation);
        const double distance = std::sqrt(double(nearest.square));
        const double share = (a.fade + t * (b.fade - a.fade)) * blurShare(distance / deviation);
        if (share <= 0) return;
        const int x = int(pixel) % mImage.width(), y = mTop + int(pixel) / mImage.width();
        const glm::dvec2 d = b.position - a.position;
        const glm::dvec2 normal = t <= 0 ? a.normal : t >= 1 ? b.normal : glm::dvec2(-d.y, d.x);
        const glm::dvec2 off = centre(x, y) - (t >= 1 ? b.position : a.position);
        const auto signedShare = float(glm::dot(off, normal) >= 0 ? share : -share);
        for (int c = 0; c < mImage.channels(); ++c) {
            const auto i = size_t(c);
            mImage.at(x, y, c) += signedShare * (a.jump[i] + t * (b.jump[i] - a.jump[i]));
        }
    }

    Image& mImage;
    int mPerSide;
    int mTop, mRows;
    std::vector<Nearest> mNearest;
    std::vector<uint32_t> mTouched;
};

}  // namespace

Image virtualSharp(const Image& image, const FeatureNetwork& network, const std::stop_token& stop) {
    TESSERA_CHECK(image.width() % network.width == 0);
    Image sharp = image;
    const int perSide = image.width() / network.width;
    const std::vector<Strand> strands = strandsOf(network);
    const size_t bands = (size_t(image.height()) + kBandRows - 1) / kBandRows;
    parallelFor(bands, 1, [&](size_t begin, size_t end) {
        for (size_t b = begin; b < end && !stop.stop_requested(); ++b) {
            Band band(sharp, perSide, int(b) * kBandRows);
            for (const Strand& strand : strands) band.apply(strand);
        }
    });
    return sharp;
}

}  // namespace tessera
