// See initial_mesh.h.
#include "core/vectorize/initial_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "core/base/check.h"
#include "core/vectorize/pixel_neighbours.h"

namespace tessera {

namespace {

// A subpixel: the middle of the grid edge between a vertex on the positive side of the feature and one on the
// negative.
struct Subpixel {
    uint32_t positive;
    uint32_t negative;
};

// The grid of pixel centres and the ring around it: vertex (i, j), 0 <= i <= width + 1, is pixel (i - 1, j -
// 1) inside.
class PixelGrid {
  public:
    PixelGrid(const Image& image, const std::vector<PixelChain>& features) : mImage(image) {
        mDiagonals.resize(size_t(columns() - 1) * size_t(rows() - 1));
        for (int j = 0; j + 1 < rows(); ++j)
            for (int i = 0; i + 1 < columns(); ++i)
                mDiagonals[cell(i, j)] =
                    difference({i, j}, {i + 1, j + 1}) > difference({i + 1, j}, {i, j + 1});
        // A chain runs along edges of the triangulation, also where it steps diagonally.
        for (const PixelChain& chain : features)
            for (size_t k = 0; k + 1 < chain.pixels.size() + chain.closed; ++k) {
                const glm::ivec2 a = chain.pixels[k] + 1, b = chain.pixels[(k + 1) % chain.pixels.size()] + 1;
                if (a.x == b.x || a.y == b.y) continue;
                mDiagonals[cell(std::min(a.x, b.x), std::min(a.y, b.y))] = (a.x < b.x) != (a.y < b.y);
            }
    }

    int columns() const { return mImage.width() + 2; }
    int rows() const { return mImage.height() + 2; }
    uint32_t vertex(glm::ivec2 g) const { return uint32_t(g.y) * uint32_t(columns()) + uint32_t(g.x); }
    glm::ivec2 place(uint32_t vertex) const {
        return {int(vertex % uint32_t(columns())), int(vertex / uint32_t(columns()))};
    }
    // Whether the cell's diagonal rises ("/") or falls ("\").
    bool rising(int i, int j) const { return mDiagonals[cell(i, j)]; }
    bool joined(glm::ivec2 a, glm::ivec2 b) const {
        if (a.x == b.x || a.y == b.y) return true;
        return rising(std::min(a.x, b.x), std::min(a.y, b.y)) == ((a.x < b.x) != (a.y < b.y));
    }
    glm::ivec2 pixel(glm::ivec2 g) const {
        return {std::clamp(g.x - 1, 0, mImage.width() - 1), std::clamp(g.y - 1, 0, mImage.height() - 1)};
    }
    float colour(glm::ivec2 g, int c) const { return mImage.at(pixel(g).x, pixel(g).y, c); }
    LatticePoint position(glm::ivec2 g) const {
        const auto along = [](int i, int size) {
            return std::clamp(i * kLatticePerPixel - kLatticePerPixel / 2, 0, size * kLatticePerPixel);
        };
        return {along(g.x, mImage.width()), along(g.y, mImage.height())};
    }

  private:
    size_t cell(int i, int j) const { return size_t(j) * size_t(columns() - 1) + size_t(i); }
    double difference(glm::ivec2 a, glm::ivec2 b) const {
        double sum = 0;
        for (int c = 0; c < mImage.channels(); ++c) {
            const double d = colour(a, c) - colour(b, c);
            sum += d * d;
        }
        return sum;
    }

    const Image& mImage;
    std::vector<bool> mDiagonals;
};

// Neighbours of chain vertex `at` on the positive (or negative) side of the way before -> at -> after, in the
// order in which the way passes them.
std::vector<uint32_t> sideFan(const PixelGrid& grid, glm::ivec2 before, glm::ivec2 at, glm::ivec2 after,
                              bool positive) {
    const auto direction = [&](glm::ivec2 to) {
        return int(std::find(kNeighbours8.begin(), kNeighbours8.end(), to - at) - kNeighbours8.begin());
    };
    const int step = positive ? 7 : 1;  // from `before` towards `after` on that side
    std::vector<uint32_t> fan;
    for (int d = (direction(before) + step) % 8; d != direction(after); d = (d + step) % 8)
        if (grid.joined(at, at + kNeighbours8[size_t(d)]))
            fan.push_back(grid.vertex(at + kNeighbours8[size_t(d)]));
    return fan;
}

// The one vertex that makes a triangle with the edge a -> b on its positive (or negative) side.
uint32_t opposite(const PixelGrid& grid, glm::ivec2 a, glm::ivec2 b, bool positive) {
    const int d = int(std::find(kNeighbours8.begin(), kNeighbours8.end(), b - a) - kNeighbours8.begin());
    for (int turn = 1; turn <= 2; ++turn) {
        const glm::ivec2 to = a + kNeighbours8[size_t((d + (positive ? turn : 8 - turn)) % 8)];
        if (grid.joined(a, to)) return grid.vertex(to);
    }
    TESSERA_CHECK(false);
}

// Follows the line half a pixel off the chain through the triangulation, as marching cubes would with the
// chain's pixels counted to the side away from it: a subpixel on each grid edge that joins the two sides, in
// order.
std::vector<Subpixel> traceSubpixels(const PixelGrid& grid, const PixelChain& chain) {
    std::vector<Subpixel> trace;
    const auto n = chain.pixels.size();
    const bool positive = chain.onPositiveSide;
    const auto at = [&](size_t k) { return chain.pixels[k % n] + 1; };
    for (size_t k = 0; k < n; ++k) {
        const uint32_t self = grid.vertex(at(k));
        std::vector<uint32_t> fan;
        if (chain.closed || (k > 0 && k + 1 < n))
            fan = sideFan(grid, at(k + n - 1), at(k), at(k + 1), positive);
        else  // an end: the triangle beside the chain's first or last edge
            fan = {k == 0 ? opposite(grid, at(0), at(1), positive)
                          : opposite(grid, at(k), at(k - 1), !positive)};
        for (const uint32_t q : fan) trace.push_back(positive ? Subpixel{q, self} : Subpixel{self, q});
    }
    return trace;
}

uint64_t edgeKey(uint32_t a, uint32_t b) {
    return uint64_t(std::min(a, b)) << 32 | std::max(a, b);
}

constexpr uint32_t kStopInterval = 4096;

using CutEdges = std::unordered_map<uint64_t, uint32_t>;  // grid edge -> its subpixel

// A triangle of the grid with its subpixels, by the patterns of Fig. 3(d).
void retriangulate(std::array<uint32_t, 3> t, const CutEdges& cuts,
                   const std::vector<LatticePoint>& positions, std::vector<std::array<uint32_t, 3>>& out) {
    std::array<uint32_t, 3> cut{};  // on the side from corner s to s + 1; none is the maximum
    int count = 0;
    for (size_t s = 0; s < 3; ++s) {
        const auto found = cuts.find(edgeKey(t[s], t[(s + 1) % 3]));
        cut[s] = found == cuts.end() ? VertexId::kNone : found->second;
        count += found != cuts.end();
    }
    TESSERA_CHECK(count <= 2);
    if (count == 0) {
        out.push_back(t);
        return;
    }
    // Rotate so that a single cut lies on the first side, and two of them on the first and the last.
    while (cut[0] == VertexId::kNone || (count == 2 && cut[2] == VertexId::kNone)) {
        std::rotate(t.begin(), t.begin() + 1, t.end());
        std::rotate(cut.begin(), cut.begin() + 1, cut.end());
    }
    if (count == 1) {
        out.push_back({t[0], cut[0], t[2]});
        out.push_back({cut[0], t[1], t[2]});
        return;
    }
    out.push_back({t[0], cut[0], cut[2]});
    const auto squared = [&](uint32_t a, uint32_t b) {
        const glm::dvec2 d = toPixels(positions[a] - positions[b]);
        return d.x * d.x + d.y * d.y;
    };
    if (squared(cut[0], t[2]) <= squared(cut[2], t[1])) {
        out.push_back({cut[0], t[1], t[2]});
        out.push_back({cut[0], t[2], cut[2]});
    } else {
        out.push_back({cut[0], t[1], cut[2]});
        out.push_back({t[1], t[2], cut[2]});
    }
}

// Marks the chain's edges and gives the corners around its vertices their copies (Fig. 4).
void splitAlong(ChannelMeshes& m, uint32_t chainIndex, const std::vector<Subpixel>& trace,
                const PixelGrid& grid) {
    const SubpixelChain& chain = m.chains[chainIndex];
    const auto n = uint32_t(chain.vertices.size());
    const uint32_t edges = chain.closed ? n : n - 1;
    std::vector<HalfedgeId> along(edges);  // from vertex k to k + 1
    for (uint32_t k = 0; k < edges; ++k) {
        along[k] = m.mesh.find(chain.vertices[k], chain.vertices[(k + 1) % n]);
        TESSERA_CHECK(along[k].valid());
        m.partOfEdge[HalfedgeMesh::edge(along[k]).index] = int32_t(m.parts.size());
        m.parts.push_back({chainIndex, k, (k + 1) % n});
    }
    for (uint32_t k = 0; k < n; ++k) {
        const VertexId v = chain.vertices[k];
        const glm::ivec2 positive = grid.place(trace[k].positive), negative = grid.place(trace[k].negative);
        const bool tip = !chain.closed && (k == 0 || k + 1 == n);
        m.kinds[v.index] = tip ? VertexKind::FeatureEnd : VertexKind::Feature;
        for (int c = 0; c < m.channels; ++c) {
            const float p = grid.colour(positive, c), q = grid.colour(negative, c);
            m.heights[size_t(v.index) * size_t(m.channels) + size_t(c)] = tip ? .5F * (p + q) : p;
        }
        if (tip) continue;
        const auto copy = uint32_t(m.copyCount());
        for (int c = 0; c < m.channels; ++c) m.heights.push_back(grid.colour(negative, c));
        const HalfedgeId forward = along[k];
        const HalfedgeId backward = HalfedgeMesh::twin(along[(k + edges - 1) % edges]);
        // rotate() turns to the negative side: from the way ahead to the way back.
        for (HalfedgeId h = m.mesh.rotate(forward);; h = m.mesh.rotate(h)) {
            m.copyOfCorner[h.index] = copy;
            if (h == backward) break;
        }
    }
}

// Taubin's lambda | mu smoothing of the heights of copies within `radius` px of features, along edges whose
// two ends lie on the same side.
void fair(ChannelMeshes& m, double radius) {
    constexpr double kLambda = .33, kMu = -.34;  // pass band .1 (Taubin 1995)
    constexpr int kRounds = 4;
    std::vector<std::vector<uint32_t>> neighbours(m.copyCount());
    std::vector<uint8_t> near(m.copyCount(), 0);
    std::vector<VertexId> vertexOfCopy(m.copyCount());
    std::vector<uint32_t> frontier;
    for (uint32_t h = 0; h < 2 * m.mesh.edgeCapacity(); ++h) {
        const HalfedgeId half(h), next = m.mesh.next(half);
        if (!m.mesh.face(half).valid()) continue;
        const uint32_t a = m.copyOfCorner[h], b = m.copyOfCorner[next.index];
        vertexOfCopy[a] = m.mesh.origin(half);
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
        if (m.kinds[m.mesh.origin(half).index] == VertexKind::Feature && !near[a]) {
            near[a] = 1;
            frontier.push_back(a);
        }
    }
    for (auto& list : neighbours) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    // Rings of neighbours out to the radius; a ring is at most a pixel wide.
    for (double reached = .5; reached <= radius; reached += 1) {
        std::vector<uint32_t> next;
        for (const uint32_t a : frontier)
            for (const uint32_t b : neighbours[a])
                if (!near[b]) {
                    near[b] = 1;
                    next.push_back(b);
                }
        frontier = std::move(next);
    }
    std::vector<float> moved = m.heights;
    for (int round = 0; round < 2 * kRounds; ++round) {
        const double factor = round % 2 == 0 ? kLambda : kMu;
        for (uint32_t a = 0; a < near.size(); ++a) {
            if (!near[a] || neighbours[a].empty()) continue;
            for (int c = 0; c < m.channels; ++c) {
                double mean = 0;
                for (const uint32_t b : neighbours[a]) mean += m.heightsOf(b)[c];
                mean /= double(neighbours[a].size());
                const double z = m.heightsOf(a)[c];
                moved[size_t(a) * size_t(m.channels) + size_t(c)] = float(z + factor * (mean - z));
            }
        }
        m.heights = moved;
    }
}

}  // namespace

Result<ChannelMeshes> buildInitialMesh(const Image& image, const std::vector<PixelChain>& features,
                                       const VectorizeSettings& settings, StageReport& report,
                                       Progress& progress) {
    const PixelGrid grid(image, features);
    ChannelMeshes m;
    m.width = image.width();
    m.height = image.height();
    m.channels = image.channels();
    const size_t gridVertices = size_t(grid.columns()) * size_t(grid.rows());
    for (uint32_t v = 0; v < gridVertices; ++v) {
        if (v % kStopInterval == 0 && !progress.step(.1)) return stopped();
        const glm::ivec2 g = grid.place(v);
        const bool sideX = g.x == 0 || g.x == grid.columns() - 1, sideY = g.y == 0 || g.y == grid.rows() - 1;
        m.positions.push_back(grid.position(g));
        m.kinds.push_back(sideX && sideY   ? VertexKind::Corner
                          : sideX || sideY ? VertexKind::Border
                                           : VertexKind::Interior);
    }
    CutEdges cuts;
    std::vector<uint8_t> touched(gridVertices, 0);
    std::vector<std::vector<Subpixel>> traces;
    for (const PixelChain& feature : features) {
        if (!progress.step(.2)) return stopped();
        traces.push_back(traceSubpixels(grid, feature));
        SubpixelChain chain{{}, feature.closed};
        for (const Subpixel& s : traces.back()) {
            const VertexId v(uint32_t(m.positions.size()));
            TESSERA_CHECK(cuts.emplace(edgeKey(s.positive, s.negative), v.index).second);
            touched[s.positive] = touched[s.negative] = 1;
            const LatticePoint sum = m.positions[s.positive] + m.positions[s.negative];
            m.positions.push_back({sum.x / 2, sum.y / 2});
            m.kinds.push_back(VertexKind::Feature);
            chain.vertices.push_back(v);
        }
        m.chains.push_back(std::move(chain));
    }

    std::vector<std::array<uint32_t, 3>> triangles;
    triangles.reserve(2 * gridVertices + 4 * cuts.size());
    for (int j = 0; j + 1 < grid.rows(); ++j) {
        if (!progress.step(.2 + .2 * j / grid.rows())) return stopped();
        for (int i = 0; i + 1 < grid.columns(); ++i) {
            const uint32_t a = grid.vertex({i, j}), b = grid.vertex({i + 1, j});
            const uint32_t c = grid.vertex({i, j + 1}), d = grid.vertex({i + 1, j + 1});
            const std::array<std::array<uint32_t, 3>, 2> halves =
                grid.rising(i, j) ? std::array<std::array<uint32_t, 3>, 2>{{{a, b, c}, {b, d, c}}}
                                  : std::array<std::array<uint32_t, 3>, 2>{{{a, b, d}, {a, d, c}}};
            for (const auto& t : halves) {
                if (touched[t[0]] + touched[t[1]] + touched[t[2]] < 2)
                    triangles.push_back(t);
                else
                    retriangulate(t, cuts, m.positions, triangles);
            }
        }
    }
    m.mesh = HalfedgeMesh::fromTriangles(m.positions.size(), triangles, progress.stopToken());
    if (!progress.step(.8)) return stopped();

    m.heights.resize(m.positions.size() * size_t(m.channels));
    for (uint32_t v = 0; v < gridVertices; ++v) {
        if (v % kStopInterval == 0 && !progress.step(.8)) return stopped();
        for (int c = 0; c < m.channels; ++c)
            m.heights[size_t(v) * size_t(m.channels) + size_t(c)] = grid.colour(grid.place(v), c);
    }
    m.copyOfCorner.resize(2 * m.mesh.edgeCapacity());
    for (uint32_t h = 0; h < m.copyOfCorner.size(); ++h)
        m.copyOfCorner[h] = m.mesh.origin(HalfedgeId(h)).index;
    m.partOfEdge.assign(m.mesh.edgeCapacity(), -1);
    for (uint32_t k = 0; k < m.chains.size(); ++k) splitAlong(m, k, traces[k], grid);
    if (!progress.step(.9)) return stopped();
    if (settings.fairingRadiusPx > 0) fair(m, settings.fairingRadiusPx);

    report.figures = {{"vertices", double(m.mesh.vertexCount())},
                      {"triangles", double(m.mesh.faceCount())},
                      {"subpixels", double(cuts.size())}};
    return m;
}

}  // namespace tessera
