// See reference_edges.h. Canny, "A computational approach to edge detection", IEEE Transactions on Pattern
// Analysis and Machine Intelligence 8(6), 1986.
#include "core/image/reference_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/image/image_compare.h"

namespace tessera {

namespace {

cv::Mat lumaOf(const Image& image) {
    const std::vector<uint8_t> rgb = rgb8OverWhite(image);
    cv::Mat luma(image.height(), image.width(), CV_8U);
    for (size_t i = 0; i < image.planeSize(); ++i)
        luma.data[i] =
            uint8_t(std::lround(.299 * rgb[3 * i] + .587 * rgb[3 * i + 1] + .114 * rgb[3 * i + 2]));
    return luma;
}

// Takes edge pixels off the map as it walks along them.
class Linker {
  public:
    explicit Linker(cv::Mat edges) : mEdges(std::move(edges)) {}

    // The chain through `start`, from end to end; empty where no edge pixel is left there.
    EdgeChain take(glm::ivec2 start) {
        EdgeChain chain;
        if (!remove(start)) return chain;
        walk(start, chain);
        std::reverse(chain.begin(), chain.end());
        chain.push_back(start);
        walk(start, chain);
        return chain;
    }

  private:
    bool remove(glm::ivec2 p) {
        if (p.x < 0 || p.y < 0 || p.x >= mEdges.cols || p.y >= mEdges.rows) return false;
        uchar& pixel = mEdges.at<uchar>(p.y, p.x);
        const bool was = pixel != 0;
        pixel = 0;
        return was;
    }

    // Adds the pixels that follow `at`. Diagonals come first and take the corners beside them off the map:
    // Canny leaves staircases, whose corners would make an oblique edge longer than it is.
    void walk(glm::ivec2 at, EdgeChain& chain) {
        static constexpr std::array<std::array<int, 2>, 8> kSteps{
            {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
        for (bool moved = true; moved;) {
            moved = false;
            for (const auto& [dx, dy] : kSteps) {
                if (!remove({at.x + dx, at.y + dy})) continue;
                if (dx != 0 && dy != 0) {
                    remove({at.x + dx, at.y});
                    remove({at.x, at.y + dy});
                }
                at = {at.x + dx, at.y + dy};
                chain.push_back(at);
                moved = true;
                break;
            }
        }
    }

    cv::Mat mEdges;
};

}  // namespace

std::vector<EdgeChain> referenceEdges(const Image& image, double sigmaPx, double low, double high,
                                      int minPixels) {
    cv::Mat luma = lumaOf(image), edges;
    if (sigmaPx > 0) cv::GaussianBlur(luma, luma, {0, 0}, sigmaPx);
    cv::Canny(luma, edges, low, high, 3, true);
    Linker linker(edges);
    std::vector<EdgeChain> chains;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (EdgeChain chain = linker.take({x, y}); int(chain.size()) >= minPixels)
                chains.push_back(std::move(chain));
    return chains;
}

double lengthPx(const EdgeChain& chain) {
    double length = 0;
    for (size_t i = 1; i < chain.size(); ++i)
        length += std::hypot(chain[i].x - chain[i - 1].x, chain[i].y - chain[i - 1].y);
    return length;
}

}  // namespace tessera
