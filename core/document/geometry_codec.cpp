// See geometry_codec.h. Predictions are exact in integers, so that they are the same on every machine.
#include "core/document/geometry_codec.h"

#include <algorithm>
#include <memory>

namespace tessera {

namespace {

constexpr size_t kActivities = 10;

struct Wide {
    int64_t x = 0, y = 0;
};
Wide wide(LatticePoint p) {
    return {p.x, p.y};
}

// numerator / denominator to the nearest, halves away from 0.
int64_t dividedRounded(int64_t numerator, int64_t denominator) {
    const int64_t half = denominator / 2;
    return numerator >= 0 ? (numerator + half) / denominator : -((-numerator + half) / denominator);
}

Wide thirdOfWay(LatticePoint a, LatticePoint b) {
    return {dividedRounded(2 * int64_t(a.x) + b.x, 3), dividedRounded(2 * int64_t(a.y) + b.y, 3)};
}

size_t activity(int64_t sum) {
    return std::min<size_t>(size_t(bitLength(sum)), kActivities - 1);
}

// Kept where codeGeometry can see that it is too far.
LatticePoint near(Wide p) {
    const auto bounded = [](int64_t c) {
        return int32_t(std::clamp<int64_t>(c, -kMaxCoordinate, kMaxCoordinate));
    };
    return {bounded(p.x), bounded(p.y)};
}

// A point as its difference from what it is expected to be. Each coordinate has models by how far off the
// neighbouring values were.
struct PointModels {
    std::array<std::array<IntModel, kActivities>, 2> models;

    // Returns |x| + |y| of the difference.
    template <class Coder>
    int64_t code(Coder& coder, LatticePoint& point, Wide expected, int64_t context) {
        int64_t dx = point.x - expected.x, dy = point.y - expected.y;
        coder.number(models[0][activity(context)], dx);
        coder.number(models[1][activity(context + std::abs(dx))], dy);
        if (!Coder::kEncodes) point = near({expected.x + dx, expected.y + dy});
        return std::abs(dx) + std::abs(dy);
    }
};

template <class Coder>
void codePositions(Coder& coder, const FileMesh& mesh, FileGeometry& g) {
    auto models = std::make_unique<std::array<PointModels, 2>>();
    std::vector<bool> known(mesh.vertexCount, false);
    const LatticePoint far{int32_t(g.width * kLatticePerPixel), int32_t(g.height * kLatticePerPixel)};
    int64_t context = 0;
    Wide last;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f)
        for (uint32_t s = 0; s < 3; ++s) {
            const uint32_t v = mesh.triangles[f][s];
            if (known[v]) continue;
            // The corner opposite the side towards an earlier triangle completes a parallelogram with that
            // triangle.
            const uint32_t opposite = (s + 1) % 3, g0 = mesh.neighbour[f][opposite];
            Wide expected = last;
            const bool predicted = g0 != FileMesh::kNone && g0 < f;
            if (predicted) {
                const auto& t = mesh.triangles[g0];
                const Wide a = wide(g.positions[mesh.triangles[f][(s + 1) % 3]]),
                           b = wide(g.positions[mesh.triangles[f][(s + 2) % 3]]),
                           c = wide(g.positions[t[(mesh.neighbourSide[f][opposite] + 2u) % 3]]);
                expected = {std::clamp<int64_t>(a.x + b.x - c.x, 0, far.x),
                            std::clamp<int64_t>(a.y + b.y - c.y, 0, far.y)};
            }
            const int64_t off = (*models)[predicted].code(coder, g.positions[v], expected, context);
            context = (context + off) / 2;
            last = wide(g.positions[v]);
            known[v] = true;
        }
}

// Whether a point is where it is expected, or an edge straight, from version 2 on: most are.
template <class Coder>
bool codeFlag(Coder& coder, BitModel& model, bool value) {
    coder.bit(model, value);
    return value;
}

template <class Coder>
void codeInner(Coder& coder, bool flags, const FileMesh& mesh, FileGeometry& g) {
    // Inside or on the border; first or second point.
    auto models = std::make_unique<std::array<std::array<PointModels, 2>, 2>>();
    std::array<std::array<std::array<BitModel, 3>, 3>, 2> curved;
    std::vector<uint8_t> curves(mesh.vertexCount, 0);  // so far, at each vertex
    int64_t context = 0;
    for (size_t e = 0; e < mesh.edges.size(); ++e) {
        const FileMesh::Edge& edge = mesh.edges[e];
        const LatticePoint a = g.positions[edge.from], b = g.positions[edge.to];
        auto& m = (*models)[edge.border];
        auto& [c1, c2] = g.inner[e];
        const Wide third = thirdOfWay(a, b), straight2 = thirdOfWay(b, a);
        if (flags) {
            const auto count = [&](uint32_t v) { return std::min<size_t>(curves[v], 2); };
            const std::array straight{near(third), near(straight2)};
            if (!codeFlag(coder, curved[edge.border][count(edge.from)][count(edge.to)],
                          g.inner[e] != straight)) {
                g.inner[e] = straight;
                continue;
            }
            for (const uint32_t v : {edge.from, edge.to}) curves[v] = uint8_t(std::min(curves[v] + 1, 2));
        }
        const int64_t first = m[0].code(coder, c1, third, edge.border ? 0 : context);
        // A curve bends to one side: its second point is off like its first.
        const Wide bend{c1.x - third.x, c1.y - third.y};
        const Wide expected{straight2.x + dividedRounded(bend.x, 2), straight2.y + dividedRounded(bend.y, 2)};
        const int64_t second = m[1].code(coder, c2, expected, first);
        if (!edge.border) context = (context + first + second) / 2;
    }
}

template <class Coder>
void codeInteriors(Coder& coder, bool flags, const FileMesh& mesh, FileGeometry& g) {
    auto models = std::make_unique<PointModels>();
    std::array<BitModel, 2> moved;
    bool last = false;
    int64_t context = 0;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        // 1/4 of the six side points less 1/6 of the corners (defaultInterior).
        Wide twelve;
        for (uint32_t s = 0; s < 3; ++s) {
            const LatticePoint corner = g.positions[mesh.triangles[f][s]];
            twelve.x -= 2 * int64_t(corner.x);
            twelve.y -= 2 * int64_t(corner.y);
            for (const LatticePoint inner : g.inner[mesh.sideEdge[f][s]]) {
                twelve.x += 3 * int64_t(inner.x);
                twelve.y += 3 * int64_t(inner.y);
            }
        }
        const Wide expected{dividedRounded(twelve.x, 12), dividedRounded(twelve.y, 12)};
        if (flags) {
            last = codeFlag(coder, moved[last], g.interior[f] != near(expected));
            if (!last) {
                g.interior[f] = near(expected);
                continue;
            }
        }
        const int64_t off = models->code(coder, g.interior[f], expected, context);
        context = (context + 2 * off) / 2;
    }
}

template <class Coder>
std::string codeGeometry(Coder& coder, bool flags, const FileMesh& mesh, FileGeometry& g) {
    codePositions(coder, mesh, g);
    codeInner(coder, flags, mesh, g);
    codeInteriors(coder, flags, mesh, g);
    const auto outside = [](LatticePoint p) {
        return std::abs(int64_t(p.x)) >= kMaxCoordinate || std::abs(int64_t(p.y)) >= kMaxCoordinate;
    };
    bool far = std::any_of(g.positions.begin(), g.positions.end(), outside) ||
               std::any_of(g.interior.begin(), g.interior.end(), outside);
    for (const auto& inner : g.inner) far = far || outside(inner[0]) || outside(inner[1]);
    return far ? "has a control point far outside the picture" : "";
}

// Features run on from edge to edge: the models go by how many features were seen at the edge's ends.
template <class Coder>
std::string codeFeatures(Coder& coder, const FileMesh& mesh, FileGeometry& g) {
    std::array<std::array<std::array<BitModel, 4>, 4>, 2> features;
    std::vector<uint8_t> seen(mesh.vertexCount, 0);
    auto blurs = std::make_unique<std::array<IntModel, 4>>();
    std::array<BitModel, 2> blurred;
    std::array<int64_t, 2> last{};
    for (size_t e = 0; e < mesh.edges.size(); ++e) {
        const FileMesh::Edge& edge = mesh.edges[e];
        FileGeometry::Attributes& a = g.attributes[e];
        const auto count = [&](uint32_t v) { return std::min<size_t>(seen[v], 3); };
        coder.bit(features[edge.border][count(edge.from)][count(edge.to)], a.feature);
        if (a.feature)
            for (const uint32_t v : {edge.from, edge.to}) seen[v] = uint8_t(std::min(seen[v] + 1, 3));
        bool hasBlur = a.blur != std::array<int64_t, 2>{};
        coder.bit(blurred[a.feature], hasBlur);
        if (!hasBlur) continue;
        for (size_t i = 0; i < 2; ++i) {
            const int64_t expected = i == 0 ? last[0] : a.blur[0];
            int64_t off = a.blur[i] - expected;
            coder.number((*blurs)[2 * a.feature + i], off);
            if (!Coder::kEncodes) a.blur[i] = std::clamp<int64_t>(expected + off, -1, kMaxBlurSteps + 1);
        }
        last = a.blur;
        if (std::min(a.blur[0], a.blur[1]) < 0 || std::max(a.blur[0], a.blur[1]) > kMaxBlurSteps)
            return "has a blur out of range";
    }
    return {};
}

// Joins by vertex; an edge by its rank among the edges at the vertex.
template <class Coder>
std::string codeJoins(Coder& coder, const FileMesh& mesh, FileGeometry& g) {
    std::vector<std::vector<uint32_t>> edgesAt(mesh.vertexCount);
    for (uint32_t e = 0; e < mesh.edges.size(); ++e)
        for (const uint32_t v : {mesh.edges[e].from, mesh.edges[e].to}) edgesAt[v].push_back(e);
    auto models = std::make_unique<std::array<IntModel, 3>>();
    auto join = g.joins.begin();
    std::vector<FileGeometry::Join> decoded;
    for (uint32_t v = 0; v < mesh.vertexCount; ++v) {
        const auto& edges = edgesAt[v];
        const auto rank = [&](uint32_t e) {
            return int64_t(std::lower_bound(edges.begin(), edges.end(), e) - edges.begin());
        };
        int64_t count = 0;
        if (Coder::kEncodes)
            while (join + count != g.joins.end() && join[count].vertex == v) ++count;
        coder.number((*models)[0], count);
        if (count < 0 || count > int64_t(edges.size()))
            return "has more smooth joins at a vertex than curves";
        for (int64_t i = 0; i < count; ++i) {
            int64_t first = Coder::kEncodes ? rank(join->first) : 0;
            coder.number((*models)[1], first);
            int64_t beyond = Coder::kEncodes ? rank(join->second) - first - 1 : 0;
            coder.number((*models)[2], beyond);
            if (first < 0 || beyond < 0 || first + 1 + beyond >= int64_t(edges.size()))
                return "has a smooth join of curves that do not meet";
            if (Coder::kEncodes)
                ++join;
            else
                decoded.push_back({v, edges[size_t(first)], edges[size_t(first + 1 + beyond)]});
            if (!Coder::kEncodes && decoded.size() > 1 && !(decoded[decoded.size() - 2] < decoded.back()))
                return "has smooth joins out of order";
        }
    }
    if (!Coder::kEncodes) g.joins = std::move(decoded);
    return {};
}

template <class Coder>
std::string codeAttributes(Coder& coder, const FileMesh& mesh, FileGeometry& g) {
    if (auto wrong = codeFeatures(coder, mesh, g); !wrong.empty()) return wrong;
    return codeJoins(coder, mesh, g);
}

}  // namespace

std::string encodeGeometry(RangeEncoder& coder, const FileMesh& mesh, FileGeometry& geometry) {
    return codeGeometry(coder, true, mesh, geometry);
}

std::string decodeGeometry(RangeDecoder& coder, uint32_t version, const FileMesh& mesh,
                           FileGeometry& geometry) {
    geometry.positions.resize(mesh.vertexCount);
    geometry.inner.resize(mesh.edges.size());
    geometry.interior.resize(mesh.triangles.size());
    std::string wrong = codeGeometry(coder, version > 1, mesh, geometry);
    return coder.overrun() ? "ends before its control points do" : wrong;
}

std::string encodeAttributes(RangeEncoder& coder, const FileMesh& mesh, FileGeometry& geometry) {
    return codeAttributes(coder, mesh, geometry);
}

std::string decodeAttributes(RangeDecoder& coder, const FileMesh& mesh, FileGeometry& geometry) {
    geometry.attributes.resize(mesh.edges.size());
    std::string wrong = codeAttributes(coder, mesh, geometry);
    return coder.overrun() ? "ends before its curves do" : wrong;
}

std::string borderViolation(const FileMesh& mesh, const FileGeometry& g) {
    const int64_t w = int64_t(g.width) * kLatticePerPixel, h = int64_t(g.height) * kLatticePerPixel;
    const std::array<Wide, 5> corners{{{0, 0}, {w, 0}, {w, h}, {0, h}, {0, 0}}};
    const auto start = std::find_if(mesh.borderLoop.begin(), mesh.borderLoop.end(), [&](uint32_t side) {
        return g.positions[mesh.triangles[side / 3][side % 3]] == LatticePoint{};
    });
    if (start == mesh.borderLoop.end()) return "has no vertex at the picture's upper left corner";
    std::vector<uint32_t> loop(start, mesh.borderLoop.end());
    loop.insert(loop.end(), mesh.borderLoop.begin(), start);

    size_t line = 0;  // runs from corners[line] to corners[line + 1]
    for (const uint32_t side : loop) {
        const uint32_t f = side / 3, s = side % 3;
        const Wide from = wide(g.positions[mesh.triangles[f][s]]),
                   to = wide(g.positions[mesh.triangles[f][(s + 1) % 3]]);
        if (line == 4) return "has a border that runs on beyond the picture's corners";
        const Wide begin = corners[line], end = corners[line + 1];
        const bool horizontal = begin.y == end.y;
        const auto along = [&](Wide p) {
            return horizontal ? (end.x > begin.x ? p.x - begin.x : begin.x - p.x)
                              : (end.y > begin.y ? p.y - begin.y : begin.y - p.y);
        };
        const auto onLine = [&](Wide p) { return horizontal ? p.y == begin.y : p.x == begin.x; };
        const auto& inner = g.inner[mesh.sideEdge[f][s]];
        for (const Wide p : {from, to, wide(inner[0]), wide(inner[1])})
            if (!onLine(p)) return "has a border that leaves the picture's sides";
        if (along(to) <= along(from) || along(to) > along(end)) return "has a border that turns back";
        if (along(to) == along(end)) ++line;
    }
    return line == 4 ? "" : "has a border that does not go around the picture";
}

}  // namespace tessera
