// See features.h.
#include "core/vectorize/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/parallel.h"
#include "core/vectorize/pixel_neighbours.h"

namespace tessera {

namespace {

class Grid {
  public:
    Grid(std::vector<uint8_t>& at, int width, int height) : mAt(at), mWidth(width), mHeight(height) {}
    bool inside(glm::ivec2 p) const { return p.x >= 0 && p.y >= 0 && p.x < mWidth && p.y < mHeight; }
    bool set(glm::ivec2 p) const { return inside(p) && mAt[index(p)] != 0; }
    void clear(glm::ivec2 p) { mAt[index(p)] = 0; }
    size_t index(glm::ivec2 p) const { return size_t(p.y) * size_t(mWidth) + size_t(p.x); }
    std::array<bool, 8> neighbours(glm::ivec2 p) const {
        std::array<bool, 8> n{};
        for (size_t i = 0; i < 8; ++i) n[i] = set(p + kNeighbours8[i]);
        return n;
    }

  private:
    std::vector<uint8_t>& mAt;
    int mWidth, mHeight;
};

}  // namespace

GradientField diZenzoGradient(const Image& image, double sigmaPx, const std::stop_token& stop) {
    const int w = image.width(), h = image.height();
    GradientField field{w, h, std::vector<float>(image.planeSize()),
                        std::vector<glm::vec2>(image.planeSize())};
    std::vector<cv::Mat> dx, dy;
    for (int c = 0; c < image.channels() && !stop.stop_requested(); ++c) {
        const cv::Mat plane(h, w, CV_32F, const_cast<float*>(image.plane(c).data()));
        cv::Mat smooth, x, y;
        cv::GaussianBlur(plane, smooth, cv::Size(), sigmaPx, sigmaPx, cv::BORDER_REPLICATE);
        const cv::Mat difference = (cv::Mat_<float>(1, 3) << -.5F, 0.F, .5F),
                      one = cv::Mat::ones(1, 1, CV_32F);
        cv::sepFilter2D(smooth, x, CV_32F, difference, one, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
        cv::sepFilter2D(smooth, y, CV_32F, one, difference, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
        dx.push_back(x);
        dy.push_back(y);
    }
    parallelFor(size_t(h), 16, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end && !stop.stop_requested(); ++row)
            for (int col = 0; col < w; ++col) {
                double xx = 0, xy = 0, yy = 0;
                for (size_t c = 0; c < dx.size(); ++c) {
                    const double gx = dx[c].at<float>(int(row), col), gy = dy[c].at<float>(int(row), col);
                    xx += gx * gx;
                    xy += gx * gy;
                    yy += gy * gy;
                }
                const double half = .5 * (xx - yy), root = std::sqrt(half * half + xy * xy);
                const double eigenvalue = .5 * (xx + yy) + root;
                const glm::dvec2 direction =
                    half >= 0 ? glm::dvec2(half + root, xy) : glm::dvec2(xy, root - half);
                const double length = glm::length(direction);
                const size_t i = row * size_t(w) + size_t(col);
                field.magnitude[i] = float(std::sqrt(eigenvalue));
                field.direction[i] = length > 0 ? glm::vec2(direction / length) : glm::vec2(1, 0);
            }
    });
    return field;
}

std::vector<uint8_t> cannyEdges(const GradientField& gradient, double low, double high,
                                const std::stop_token& stop) {
    const int w = gradient.width, h = gradient.height;
    const auto magnitudeAt = [&](double x, double y) {
        const int x0 = std::clamp(int(std::floor(x)), 0, w - 2),
                  y0 = std::clamp(int(std::floor(y)), 0, h - 2);
        const double fx = x - x0, fy = y - y0;
        const auto value = [&](int col, int row) { return double(gradient.at(col, row)); };
        return (1 - fy) * ((1 - fx) * value(x0, y0) + fx * value(x0 + 1, y0)) +
               fy * ((1 - fx) * value(x0, y0 + 1) + fx * value(x0 + 1, y0 + 1));
    };
    std::vector<uint8_t> edges(gradient.magnitude.size(), 0);
    Grid grid(edges, w, h);
    std::vector<glm::ivec2> strong;
    constexpr uint8_t kMaximum = 1, kAccepted = 2;
    // The outermost pixels have no gradient across them, and a chain there would leave no room for its
    // subpixels.
    for (int y = 1; y + 1 < h && !stop.stop_requested(); ++y)
        for (int x = 1; x + 1 < w; ++x) {
            const double m = gradient.at(x, y);
            if (m < low || m <= 0) continue;
            const glm::dvec2 d = gradient.direction[grid.index({x, y})];
            if (m < magnitudeAt(x + d.x, y + d.y) || m <= magnitudeAt(x - d.x, y - d.y)) continue;
            edges[grid.index({x, y})] = kMaximum;
            if (m >= high) strong.emplace_back(x, y);
        }
    for (const glm::ivec2 p : strong) edges[grid.index(p)] = kAccepted;
    while (!strong.empty()) {
        const glm::ivec2 p = strong.back();
        strong.pop_back();
        for (const glm::ivec2 step : kNeighbours8) {
            const glm::ivec2 q = p + step;
            if (!grid.inside(q) || edges[grid.index(q)] != kMaximum) continue;
            edges[grid.index(q)] = kAccepted;
            strong.push_back(q);
        }
    }
    for (uint8_t& e : edges) e = e == kAccepted;
    return edges;
}

void thin(std::vector<uint8_t>& edges, int width, int height, const std::stop_token& stop) {
    Grid grid(edges, width, height);
    std::vector<glm::ivec2> set;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (edges[grid.index({x, y})]) set.emplace_back(x, y);

    for (bool changed = true; changed && !stop.stop_requested();) {
        changed = false;
        for (int pass = 0; pass < 2; ++pass) {
            std::vector<glm::ivec2> removed;
            for (const glm::ivec2 p : set) {
                const auto n = grid.neighbours(p);
                const bool east = n[0], south = n[2], west = n[4], north = n[6];
                int count = 0, transitions = 0;
                for (size_t i = 0; i < 8; ++i) {
                    count += n[i];
                    transitions += !n[i] && n[(i + 1) % 8];
                }
                // At least 3, not 2: else the ends of a staircase go, again and again, until nothing is left
                // of it.
                if (count < 3 || count > 6 || transitions != 1) continue;
                const bool free = pass == 0 ? !(north && east && south) && !(east && south && west)
                                            : !(north && east && west) && !(north && south && west);
                if (free) removed.push_back(p);
            }
            for (const glm::ivec2 p : removed) grid.clear(p);
            changed = changed || !removed.empty();
            std::erase_if(set, [&](glm::ivec2 p) { return !grid.set(p); });
        }
    }
    // A pixel between two of its direct neighbours that touch each other diagonally adds nothing to the line.
    for (const glm::ivec2 p : set) {
        const auto n = grid.neighbours(p);
        for (size_t i = 0; i < 8; i += 2) {
            const bool corner =
                n[i] && n[(i + 2) % 8] && !n[(i + 4) % 8] && !n[(i + 5) % 8] && !n[(i + 6) % 8];
            if (!corner) continue;
            grid.clear(p);
            break;
        }
    }
}

void removeJunctions(std::vector<uint8_t>& edges, const GradientField& gradient) {
    Grid grid(edges, gradient.width, gradient.height);
    std::vector<glm::ivec2> set;
    for (int y = 0; y < gradient.height; ++y)
        for (int x = 0; x < gradient.width; ++x)
            if (edges[grid.index({x, y})]) set.emplace_back(x, y);
    // Strong lines first: they keep their course, and weaker ones end at them.
    std::stable_sort(set.begin(), set.end(), [&](glm::ivec2 a, glm::ivec2 b) {
        return gradient.at(a.x, a.y) > gradient.at(b.x, b.y);
    });
    for (const glm::ivec2 p : set) {
        if (!grid.set(p)) continue;
        std::vector<glm::ivec2> neighbours;
        for (const glm::ivec2 step : kNeighbours8)
            if (grid.set(p + step)) neighbours.push_back(p + step);
        std::stable_sort(neighbours.begin(), neighbours.end(), [&](glm::ivec2 a, glm::ivec2 b) {
            return gradient.at(a.x, a.y) > gradient.at(b.x, b.y);
        });
        for (size_t i = 2; i < neighbours.size(); ++i) grid.clear(neighbours[i]);
    }
}

std::vector<PixelChain> linkChains(const std::vector<uint8_t>& edges, int width, int height, int minPixels) {
    std::vector<uint8_t> left = edges;
    Grid grid(left, width, height);
    std::vector<PixelChain> chains;
    const auto countNeighbours = [&](glm::ivec2 p) {
        const auto n = grid.neighbours(p);
        return std::count(n.begin(), n.end(), true);
    };
    const auto follow = [&](glm::ivec2 start, bool closed) {
        PixelChain chain;
        chain.closed = closed;
        for (glm::ivec2 p = start;;) {
            chain.pixels.push_back(p);
            grid.clear(p);
            glm::ivec2 next(-1);
            for (const glm::ivec2 step : kNeighbours8)
                if (grid.set(p + step)) {
                    next = p + step;
                    break;
                }
            if (next.x < 0) break;
            p = next;
        }
        if (int(chain.pixels.size()) >= minPixels) chains.push_back(std::move(chain));
    };
    for (const bool closed : {false, true})
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (grid.set({x, y}) && (closed || countNeighbours({x, y}) <= 1)) follow({x, y}, closed);
    return chains;
}

void chooseSide(PixelChain& chain, const Image& image) {
    const int n = int(chain.pixels.size());
    const auto pixel = [&](int i) {
        return chain.closed ? chain.pixels[size_t((i % n + n) % n)]
                            : chain.pixels[size_t(std::clamp(i, 0, n - 1))];
    };
    double lead = 0;  // of the positive side
    for (int i = 0; i < n; ++i) {
        const glm::dvec2 along = glm::dvec2(pixel(i + 2) - pixel(i - 2));
        const double length = glm::length(along);
        if (length <= 0) continue;
        const glm::dvec2 normal = glm::dvec2(-along.y, along.x) / length, at = glm::dvec2(pixel(i)) + .5;
        double positive = 0, negative = 0;
        for (int c = 0; c < image.channels(); ++c) {
            const double here = image.at(pixel(i).x, pixel(i).y, c);
            const double p = bilinear(image, c, at.x + normal.x, at.y + normal.y) - here;
            const double m = bilinear(image, c, at.x - normal.x, at.y - normal.y) - here;
            positive += p * p;
            negative += m * m;
        }
        lead += std::sqrt(positive) - std::sqrt(negative);
    }
    chain.onPositiveSide = lead >= 0;
}

Result<std::vector<PixelChain>> detectFeatures(const Image& image, const VectorizeSettings& settings,
                                               StageReport& report, Progress& progress) {
    std::vector<PixelChain> chains;
    if (report.variant == "none" || image.width() < 3 || image.height() < 3) return chains;

    const GradientField gradient = diZenzoGradient(image, settings.featureSigmaPx, progress.stopToken());
    if (!progress.step(.3)) return stopped();
    const double largest = *std::max_element(gradient.magnitude.begin(), gradient.magnitude.end());
    // Below a hundredth of a level a "largest gradient" is rounding.
    constexpr double kFlat = .01 / 255;
    if (largest < kFlat) return chains;
    auto edges =
        cannyEdges(gradient, settings.cannyLow * largest, settings.cannyHigh * largest, progress.stopToken());
    if (!progress.step(.5)) return stopped();
    thin(edges, image.width(), image.height(), progress.stopToken());
    removeJunctions(edges, gradient);
    if (!progress.step(.8)) return stopped();
    chains = linkChains(edges, image.width(), image.height(), settings.minChainPixels);
    size_t pixels = 0;
    for (PixelChain& chain : chains) {
        if (!progress.step(.9)) return stopped();
        chooseSide(chain, image);
        pixels += chain.pixels.size();
    }
    report.figures = {
        {"largest gradient", largest}, {"chains", double(chains.size())}, {"chain pixels", double(pixels)}};
    return chains;
}

}  // namespace tessera
