// See subpixel_features.h.
#include "core/vectorize/subpixel_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "core/base/parallel.h"
#include "core/mesh/lattice.h"
#include "core/vectorize/edge_curves.h"
#include "core/vectorize/feature_joins.h"
#include "core/vectorize/feature_profile.h"

namespace tessera {

namespace {

constexpr std::array kScalesPx{.7, 1.6, 3.6};
constexpr size_t kOutlineScale = 1;  // at which features are judged
constexpr double kStepPx = .8;       // between points of a chain
constexpr double kBorderPx = 1.5;
constexpr double kVisible = 4.0 / 255;
constexpr double kSurfacePx = .92 * kMostBlurPx;  // what is blurred more is a surface's shading
constexpr int kTurnPoints = 3;                    // on either side of a corner

// Points at even steps of about kStepPx.
FeatureChain resampled(const EdgeCurve& curve, double scalePx) {
    std::vector<EdgeCurve::Point> points = curve.points;
    if (curve.closed) points.push_back(EdgeCurve::Point(points.front()));
    std::vector<double> arc(points.size(), 0);
    for (size_t i = 1; i < points.size(); ++i)
        arc[i] = arc[i - 1] + glm::distance(points[i - 1].position, points[i].position);
    const int steps = std::max(int(std::lround(arc.back() / kStepPx)), 2);
    FeatureChain chain;
    chain.closed = curve.closed;
    size_t k = 0;
    for (int i = 0; i < (curve.closed ? steps : steps + 1); ++i) {
        const double at = arc.back() * i / steps;
        while (k + 2 < arc.size() && arc[k + 1] < at) ++k;
        const double gap = arc[k + 1] - arc[k], t = gap > 0 ? std::clamp((at - arc[k]) / gap, 0.0, 1.0) : 0;
        FeaturePoint p;
        p.position = points[k].position + t * (points[k + 1].position - points[k].position);
        const double variance = points[k].variance + t * (points[k + 1].variance - points[k].variance) -
                                EdgeCurveFinder::smoothingVariance(scalePx) - 1.0 / 12;
        p.sigma = std::clamp(float(std::sqrt(std::max(variance, 0.0))), kLeastBlurPx, kMostBlurPx);
        chain.points.push_back(p);
    }
    return chain;
}

size_t wrapped(const FeatureChain& chain, int i) {
    const auto n = int(chain.points.size());
    return size_t(((i % n) + n) % n);
}

// Angle, in radians, from the direction over points [a, b] to that over [c, d].
double turn(const FeatureChain& chain, int a, int b, int c, int d) {
    const auto at = [&](int i) { return chain.points[wrapped(chain, i)].position; };
    const glm::dvec2 in = at(b) - at(a), out = at(d) - at(c);
    return std::atan2(cross(in, out), glm::dot(in, out));
}

// A corner turns within the few px that blur leaves of it; a curve that goes on turning is none.
std::vector<uint32_t> findCorners(const FeatureChain& chain, double degrees) {
    const auto n = int(chain.points.size());
    const double least = degrees * std::acos(-1.0) / 180;
    std::vector<double> turns(chain.points.size(), 0);
    const int from = chain.closed ? 0 : kTurnPoints, to = chain.closed ? n : n - kTurnPoints;
    if (n < 4 * kTurnPoints) return {};
    for (int i = from; i < to; ++i) {
        const double here = turn(chain, i - kTurnPoints, i, i, i + kTurnPoints);
        int before = i - 3 * kTurnPoints, after = i + 3 * kTurnPoints;
        if (!chain.closed) before = std::max(before, 0), after = std::min(after, n - 1);
        const double around =
            turn(chain, before, std::min(before + kTurnPoints, i), std::max(after - kTurnPoints, i), after);
        if (std::abs(here) > least && std::abs(here) > .55 * std::abs(around))
            turns[size_t(i)] = std::abs(here);
    }
    std::vector<uint32_t> corners;
    for (int i = from; i < to; ++i) {
        if (turns[size_t(i)] <= 0) continue;
        bool largest = true;
        for (int k = -kTurnPoints; k <= kTurnPoints && largest; ++k) {
            const size_t j = chain.closed ? wrapped(chain, i + k) : size_t(std::clamp(i + k, 0, n - 1));
            largest = turns[j] < turns[size_t(i)] || (turns[j] == turns[size_t(i)] && int(j) >= i);
        }
        if (largest) corners.push_back(uint32_t(i));
    }
    return corners;
}

// Replaces each point by the value of the parabola through its neighbours (Savitzky and Golay 1964), which
// keeps curvature; moves it by kMostShiftPx at most, corners and ends not at all.
void smooth(FeatureChain& chain, double cornerDegrees) {
    constexpr double kMostShiftPx = .1;
    const auto n = int(chain.points.size());
    const std::vector<uint32_t> corners = findCorners(chain, cornerDegrees);
    std::vector<int> room(chain.points.size(), 4);  // points to the next corner or end
    for (int i = 0; i < n && !chain.closed; ++i) room[size_t(i)] = std::min({4, i, n - 1 - i});
    for (const uint32_t corner : corners)
        for (int k = -4; k <= 4; ++k) {
            const int j = int(corner) + k;
            if (!chain.closed && (j < 0 || j >= n)) continue;
            int& r = room[wrapped(chain, j)];
            r = std::min(r, std::abs(k));
        }
    if (n < 10) return;
    std::vector<glm::dvec2> moved(chain.points.size());
    for (int i = 0; i < n; ++i) {
        const int m = room[size_t(i)];
        const glm::dvec2 here = chain.points[size_t(i)].position;
        moved[size_t(i)] = here;
        if (m < 2) continue;
        // Weights 3 (3m^2 + 3m - 1 - 5k^2) / ((2m - 1)(2m + 1)(2m + 3)).
        glm::dvec2 sum(0);
        for (int k = -m; k <= m; ++k)
            sum += double(3 * (3 * m * m + 3 * m - 1 - 5 * k * k)) *
                   chain.points[wrapped(chain, i + k)].position;
        const glm::dvec2 shift = sum / double((2 * m - 1) * (2 * m + 1) * (2 * m + 3)) - here;
        const double length = glm::length(shift);
        moved[size_t(i)] += length > kMostShiftPx ? shift * (kMostShiftPx / length) : shift;
    }
    for (size_t i = 0; i < moved.size(); ++i) chain.points[i].position = moved[i];
}

// Removes what runs along the picture's border so close that no patch has room between.
std::vector<FeatureChain> awayFromBorder(std::vector<FeatureChain> chains, int width, int height) {
    constexpr double kRoomPx = 5, kParallel = .35;
    std::vector<FeatureChain> kept;
    for (FeatureChain& chain : chains) {
        const auto n = int(chain.points.size());
        std::vector<bool> drop(chain.points.size(), false);
        for (int i = 0; i < n; ++i) {
            const auto at = [&](int k) {
                return chain
                    .points[chain.closed ? wrapped(chain, i + k) : size_t(std::clamp(i + k, 0, n - 1))]
                    .position;
            };
            const glm::dvec2 p = at(0), along = at(3) - at(-3);
            const double length = glm::length(along);
            drop[size_t(i)] =
                (std::min(p.x, width - p.x) < kRoomPx && std::abs(along.x) < kParallel * length) ||
                (std::min(p.y, height - p.y) < kRoomPx && std::abs(along.y) < kParallel * length);
        }
        for (FeatureChain& part : withoutPoints(std::move(chain), drop)) kept.push_back(std::move(part));
    }
    return kept;
}

// Extends ends within kBorderPx of the picture's border straight to it.
void extendToBorder(FeatureChain& chain, int width, int height) {
    if (chain.closed) return;
    for (const bool last : {false, true}) {
        if (chain.ends[last] != ChainEnd::Tip) continue;
        FeaturePoint end = last ? chain.points.back() : chain.points.front();
        const glm::dvec2 p = end.position, d = outward(chain, last);
        double best = 1e9;
        glm::dvec2 hit(0);
        for (const int axis : {0, 1}) {
            const double most = axis ? height : width, side = d[axis] < 0 ? 0 : most;
            const double gap = std::abs(side - p[axis]);
            // A chain that runs along the border more than toward it does not end there.
            if (gap > kBorderPx || std::abs(d[axis]) < .4 || gap / std::abs(d[axis]) >= best) continue;
            best = gap / std::abs(d[axis]);
            hit = p + best * d;
            hit[axis] = side;
        }
        if (best > 1e8) continue;
        hit = glm::clamp(hit, glm::dvec2(0), glm::dvec2(width, height));
        chain.ends[last] = ChainEnd::Border;
        if (!last) reverse(chain);
        const int steps = std::max(int(std::ceil(glm::distance(p, hit))), 1);
        for (int i = 1; i <= steps; ++i) {
            end.position = i == steps ? hit : p + (hit - p) * (double(i) / steps);
            chain.points.push_back(end);
        }
        if (!last) reverse(chain);
    }
}

void setImportance(FeatureChain& chain, const std::vector<float>& squaredGradient, int width, int height) {
    chain.importance = 0;
    const double perPoint = lengthPx(chain) / double(chain.points.size());
    for (const FeaturePoint& p : chain.points) {
        const int x = std::clamp(int(p.position.x), 0, width - 1);
        const int y = std::clamp(int(p.position.y), 0, height - 1);
        const double square = squaredGradient[size_t(y) * size_t(width) + size_t(x)];
        chain.importance += square * std::sqrt(square) * perPoint;
    }
}

// Drops what is too short: spurs first, then what they held apart may be longer.
std::vector<FeatureChain> dropShort(std::vector<FeatureChain> chains, double minLengthPx) {
    constexpr double kLeastBetweenJunctionsPx = 4;
    for (int round = 0; round < 3; ++round) {
        std::erase_if(chains, [&](const FeatureChain& c) {
            const bool held = !c.closed && c.ends[0] == ChainEnd::Junction && c.ends[1] == ChainEnd::Junction;
            return lengthPx(c) < (held ? kLeastBetweenJunctionsPx : minLengthPx);
        });
        chains = settleJunctions(std::move(chains));
    }
    return chains;
}

void eachChain(std::vector<FeatureChain>& chains, const std::function<void(FeatureChain&)>& body) {
    parallelFor(chains.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) body(chains[i]);
    });
}

}  // namespace

double lengthPx(const FeatureChain& chain) {
    double sum = 0;
    for (size_t i = 1; i < chain.points.size(); ++i)
        sum += glm::distance(chain.points[i - 1].position, chain.points[i].position);
    if (chain.closed) sum += glm::distance(chain.points.back().position, chain.points.front().position);
    return sum;
}

Result<std::vector<FeatureChain>> detectSubpixelFeatures(const Image& image,
                                                         const VectorizeSettings& settings,
                                                         StageReport& report, Progress& progress) {
    std::vector<FeatureChain> chains;
    std::vector<float> outlineGradient;
    if (image.width() < 3 || image.height() < 3) return chains;
    {
        EdgeCurveFinder finder(image, progress.stopToken());
        for (size_t s = 0; s < kScalesPx.size(); ++s) {
            const auto curves = finder.find(kScalesPx[s], s + 1 < kScalesPx.size() ? kScalesPx[s + 1] : 0,
                                            .5 * settings.minChainPixels);
            for (const EdgeCurve& curve : curves) chains.push_back(resampled(curve, kScalesPx[s]));
            if (s == kOutlineScale) outlineGradient = finder.squaredGradient();
            if (!progress.step(.2 * double(s + 1))) return stopped();
        }
    }
    chains = joinTips(awayFromBorder(std::move(chains), image.width(), image.height()));
    eachChain(chains, [&](FeatureChain& chain) { smooth(chain, settings.cornerDegrees); });
    eachChain(chains, [&](FeatureChain& chain) { extendToBorder(chain, image.width(), image.height()); });
    if (!progress.step(.65)) return stopped();
    chains = dropShort(joinJunctions(std::move(chains)), settings.minChainPixels);
    if (!progress.step(.7)) return stopped();
    fitProfiles(image, chains, progress.stopToken());
    if (!progress.step(.95)) return stopped();
    std::erase_if(chains, [](const FeatureChain& chain) {
        double contrast = 0, sigma = 0;
        for (const FeaturePoint& p : chain.points) contrast += p.contrast, sigma += p.sigma;
        const auto n = double(chain.points.size());
        return contrast < kVisible * n || sigma > kSurfacePx * n;
    });
    chains = dropShort(std::move(chains), settings.minChainPixels);
    eachChain(chains, [&](FeatureChain& chain) {
        chain.corners = findCorners(chain, settings.cornerDegrees);
        setImportance(chain, outlineGradient, image.width(), image.height());
    });
    double length = 0;
    for (const FeatureChain& chain : chains) length += lengthPx(chain);
    report.figures.emplace_back("chains", double(chains.size()));
    report.figures.emplace_back("length px", length);
    if (!progress.step(1)) return stopped();
    return chains;
}

double segmentsNeeded(const FeatureChain& chain) {
    constexpr double kLengthPx = 40, kTurn = 75 * std::numbers::pi / 180;
    constexpr size_t kReach = 3;  // points over which a direction is taken
    const size_t n = chain.points.size(), margin = chain.closed ? 0 : kReach;
    double turning = 0;
    for (size_t i = margin; i + margin < n; ++i) {
        const glm::dvec2 at = chain.points[i].position;
        const glm::dvec2 in = at - chain.points[(i + n - kReach % n) % n].position;
        const glm::dvec2 out = chain.points[(i + kReach) % n].position - at;
        turning += std::abs(std::atan2(in.x * out.y - in.y * out.x, glm::dot(in, out)));
    }
    // Each turn is seen from kReach points.
    return 1 + lengthPx(chain) / kLengthPx + turning / double(kReach) / kTurn;
}

std::vector<FeatureChain> selectFeatures(std::vector<FeatureChain> chains, double segmentBudget) {
    // A line through junctions counts as one, so that it is not kept in pieces.
    const std::vector<uint32_t> lines = throughLines(chains);
    std::vector<double> segments, lineSegments(chains.size(), 0), lineImportance(chains.size(), 0);
    for (size_t i = 0; i < chains.size(); ++i) {
        segments.push_back(segmentsNeeded(chains[i]));
        lineSegments[lines[i]] += segments[i];
        lineImportance[lines[i]] += chains[i].importance;
    }
    const auto worth = [&](size_t i) { return lineImportance[lines[i]] / lineSegments[lines[i]]; };
    std::vector<size_t> order(chains.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return worth(a) > worth(b); });
    std::vector<bool> keep(chains.size(), false);
    double total = 0;
    for (const size_t i : order) {
        if (total + segments[i] > segmentBudget) continue;
        total += segments[i];
        keep[i] = true;
    }
    std::vector<FeatureChain> kept;
    for (size_t i = 0; i < chains.size(); ++i)
        if (keep[i]) kept.push_back(std::move(chains[i]));
    return settleJunctions(std::move(kept));
}

}  // namespace tessera
