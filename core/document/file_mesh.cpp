// See file_mesh.h. The traversal is that of Rossignac's Edgebreaker (1999) with a learnt code for each step,
// and with vertices named outright where Edgebreaker would split its front.
#include "core/document/file_mesh.h"

#include <algorithm>
#include <unordered_set>

#include "core/document/range_coder.h"

namespace tessera {

namespace {

// What lies across a side of a triangle that was already visited: nothing, or a triangle whose third vertex
// is a new one, the neighbour on the front beyond one end of the side, or any other known one.
enum class Step { New, AfterTo, BeforeFrom, Known, Border };

uint64_t directed(uint32_t from, uint32_t to) {
    return uint64_t(from) << 32 | to;
}

// The state of a traversal that encoder and decoder share: which sides are done, the front as far as it
// predicts, and the models.
class Traversal {
  public:
    struct Side {
        uint32_t from = 0, to = 0;
    };

    explicit Traversal(size_t faceCount) { mDone.reserve(3 * faceCount); }

    void addVertex() {
        mAfter.push_back(0);
        mBefore.push_back(0);
        mDegree.push_back(0);
    }
    uint32_t vertexCount() const { return uint32_t(mAfter.size()); }

    // False where one of its directed sides is there already.
    bool addTriangle(uint32_t a, uint32_t b, uint32_t c) {
        for (const uint32_t v : {a, b, c}) ++mDegree[v];
        const bool first = mDone.insert(directed(a, b)).second, second = mDone.insert(directed(b, c)).second,
                   third = mDone.insert(directed(c, a)).second;
        return first && second && third;
    }
    bool done(uint32_t from, uint32_t to) const { return mDone.contains(directed(from, to)); }

    void link(uint32_t from, uint32_t to) {
        mAfter[from] = to;
        mBefore[to] = from;
    }

    // The step across `side`; `third` is the vertex beyond where there is one (kNone: new), set where
    // decoding.
    template <class Coder>
    Step code(Coder& coder, Side side, Step step, uint32_t& third) {
        const uint32_t afterTo = mAfter[side.to], beforeFrom = mBefore[side.from];
        if (Coder::kEncodes && step == Step::Known) {
            if (third == afterTo)
                step = Step::AfterTo;
            else if (third == beforeFrom)
                step = Step::BeforeFrom;
        }
        auto& models = mSteps[std::min<size_t>(mDegree[side.to], kDegrees - 1)]
                             [std::min<size_t>(mDegree[side.from], kDegrees - 1)][size_t(mLast)];
        constexpr std::array<Step, 4> kOrder{Step::New, Step::AfterTo, Step::BeforeFrom, Step::Border};
        Step found = Step::Known;
        for (size_t i = 0; i < kOrder.size(); ++i) {
            bool is = step == kOrder[i];
            coder.bit(models[i], is);
            if (!is) continue;
            found = kOrder[i];
            break;
        }
        if (found == Step::AfterTo) third = afterTo;
        if (found == Step::BeforeFrom) third = beforeFrom;
        if (found == Step::New) third = vertexCount();
        if (found == Step::Known) {
            int64_t back = int64_t(vertexCount()) - 1 - int64_t(third);
            coder.number(mBack, back);
            third = uint32_t(
                std::clamp<int64_t>(int64_t(vertexCount()) - 1 - back, 0, int64_t(vertexCount()) - 1));
        }
        mLast = found;
        return found;
    }

    // Which corner of a triangle, counted from the side that led to it, is the patch's corner a.
    template <class Coder>
    uint32_t codeCorner(Coder& coder, uint32_t corner) {
        bool later = corner != 0, last = corner == 2;
        coder.bit(mCorner[0], later);
        if (!later) return 0;
        coder.bit(mCorner[1], last);
        return last ? 2 : 1;
    }

  private:
    static constexpr size_t kDegrees = 8;

    std::unordered_set<uint64_t> mDone;
    std::vector<uint32_t> mAfter, mBefore;  // along the front, triangles on its left
    std::vector<uint32_t> mDegree;          // triangles so far
    Step mLast = Step::New;
    std::array<BitModel, 4> mSteps[kDegrees][kDegrees][5];
    std::array<BitModel, 2> mCorner;
    IntModel mBack;
};

}  // namespace

FileOrder encodeConnectivity(RangeEncoder& coder, const HalfedgeMesh& mesh) {
    FileOrder order;
    FaceId first(0);
    while (first.index < mesh.faceCapacity() && !mesh.alive(first)) ++first.index;
    if (first.index == mesh.faceCapacity()) return {};

    Traversal traversal(mesh.faceCount());
    std::vector<uint32_t> fileVertex(mesh.vertexCapacity(), FileMesh::kNone);
    const auto number = [&](VertexId v) {
        if (fileVertex[v.index] == FileMesh::kNone) {
            fileVertex[v.index] = traversal.vertexCount();
            order.vertices.push_back(v);
            traversal.addVertex();
        }
        return fileVertex[v.index];
    };
    std::vector<HalfedgeId> sides;  // of visited triangles, still to cross
    const auto start = mesh.sides(first);
    order.faces.push_back(first);
    std::array<uint32_t, 3> v{};
    for (size_t i = 0; i < 3; ++i) v[i] = number(mesh.origin(start[i]));
    traversal.addTriangle(v[0], v[1], v[2]);
    for (size_t i = 0; i < 3; ++i) traversal.link(v[i], v[(i + 1) % 3]);
    sides = {start[2], start[1], start[0]};

    while (!sides.empty()) {
        const HalfedgeId side = sides.back(), across = HalfedgeMesh::twin(side);
        sides.pop_back();
        const uint32_t from = fileVertex[mesh.origin(side).index], to = fileVertex[mesh.target(side).index];
        if (traversal.done(to, from)) continue;
        const FaceId face = mesh.face(across);
        Step step = Step::Border;
        uint32_t third = FileMesh::kNone;
        if (face.valid()) {
            third = fileVertex[mesh.target(mesh.next(across)).index];
            step = third == FileMesh::kNone ? Step::New : Step::Known;
        }
        if (traversal.code(coder, {from, to}, step, third) == Step::Border) continue;
        // The triangle (to, from, third).
        const HalfedgeId own = mesh.halfedge(face), left = mesh.next(across), right = mesh.next(left);
        traversal.codeCorner(coder, own == across ? 0 : own == left ? 1 : 2);
        number(mesh.target(left));
        order.faces.push_back(face);
        traversal.addTriangle(to, from, third);
        traversal.link(from, third);
        traversal.link(third, to);
        sides.push_back(left);
        sides.push_back(right);
    }
    if (order.faces.size() != mesh.faceCount()) return {};
    return order;
}

std::string decodeConnectivity(RangeDecoder& coder, size_t faceCount, FileMesh& mesh) {
    Traversal traversal(faceCount);
    mesh.triangles.clear();
    mesh.triangles.reserve(faceCount);
    for (int i = 0; i < 3; ++i) traversal.addVertex();
    mesh.triangles.push_back({0, 1, 2});
    traversal.addTriangle(0, 1, 2);
    for (uint32_t i = 0; i < 3; ++i) traversal.link(i, (i + 1) % 3);
    std::vector<Traversal::Side> sides{{2, 0}, {1, 2}, {0, 1}};

    while (!sides.empty()) {
        const auto side = sides.back();
        sides.pop_back();
        if (traversal.done(side.to, side.from)) continue;
        uint32_t third = 0;
        const Step step = traversal.code(coder, side, Step::Border, third);
        if (coder.overrun()) return "ends before its triangles do";
        if (step == Step::Border) continue;
        if (mesh.triangles.size() == faceCount) return "has more triangles than it says";
        if (step == Step::New) traversal.addVertex();
        const std::array<uint32_t, 3> corners{side.to, side.from, third};
        const uint32_t a = traversal.codeCorner(coder, 0);
        if (third == side.to || third == side.from || !traversal.addTriangle(side.to, side.from, third))
            return "has a triangle over another";
        mesh.triangles.push_back({corners[a], corners[(a + 1) % 3], corners[(a + 2) % 3]});
        traversal.link(side.from, third);
        traversal.link(third, side.to);
        sides.push_back({side.from, third});
        sides.push_back({third, side.to});
    }
    if (mesh.triangles.size() != faceCount) return "has fewer triangles than it says";
    mesh.vertexCount = traversal.vertexCount();
    return {};
}

std::string deriveFileMesh(FileMesh& mesh) {
    const auto faceCount = uint32_t(mesh.triangles.size());
    mesh.edges.clear();
    mesh.sideEdge.assign(faceCount, {FileMesh::kNone, FileMesh::kNone, FileMesh::kNone});
    mesh.neighbour = mesh.sideEdge;
    mesh.neighbourSide.assign(faceCount, {});

    // Sides sorted by their edge; an edge's sides come together, the first triangle's first.
    struct Key {
        uint64_t edge;
        uint32_t side;
    };
    std::vector<Key> keys;
    keys.reserve(3 * size_t(faceCount));
    const auto from = [&](uint32_t side) { return mesh.triangles[side / 3][side % 3]; };
    const auto to = [&](uint32_t side) { return mesh.triangles[side / 3][(side % 3 + 1) % 3]; };
    for (uint32_t side = 0; side < 3 * faceCount; ++side) {
        if (from(side) >= mesh.vertexCount || from(side) == to(side)) return "has a triangle of no area";
        keys.push_back({directed(std::min(from(side), to(side)), std::max(from(side), to(side))), side});
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.side < b.side;
    });
    for (size_t i = 0; i < keys.size();) {
        size_t end = i + 1;
        while (end < keys.size() && keys[end].edge == keys[i].edge) ++end;
        if (end - i > 2) return "has an edge of three triangles";
        if (end - i == 2) {
            const uint32_t s = keys[i].side, t = keys[i + 1].side;
            if (from(s) != to(t)) return "has two triangles on one side of an edge";
            mesh.neighbour[s / 3][s % 3] = t / 3;
            mesh.neighbour[t / 3][t % 3] = s / 3;
            mesh.neighbourSide[s / 3][s % 3] = uint8_t(t % 3);
            mesh.neighbourSide[t / 3][t % 3] = uint8_t(s % 3);
        }
        i = end;
    }
    std::vector<uint32_t> cornersAt(mesh.vertexCount, 0), cornerOf(mesh.vertexCount, FileMesh::kNone);
    size_t borderSides = 0;
    for (uint32_t side = 0; side < 3 * faceCount; ++side) {
        const uint32_t f = side / 3, s = side % 3, g = mesh.neighbour[f][s];
        const bool later = g < f || (g == f && mesh.neighbourSide[f][s] < s);
        if (later) {
            mesh.sideEdge[f][s] = mesh.sideEdge[g][mesh.neighbourSide[f][s]];
            mesh.edges[mesh.sideEdge[f][s]].border = false;
        } else {
            mesh.sideEdge[f][s] = uint32_t(mesh.edges.size());
            mesh.edges.push_back({from(side), to(side), f, uint8_t(s), true});
        }
        ++cornersAt[from(side)];
        // On the border the fan starts at the side that lies on it.
        if (cornerOf[from(side)] == FileMesh::kNone || g == FileMesh::kNone) cornerOf[from(side)] = side;
        if (g == FileMesh::kNone) ++borderSides;
    }
    if (int64_t(mesh.vertexCount) - int64_t(mesh.edges.size()) + faceCount != 1) return "is not a disc";

    // Around each vertex from triangle to triangle, over the side that enters it.
    for (uint32_t v = 0; v < mesh.vertexCount; ++v) {
        if (cornerOf[v] == FileMesh::kNone) return "has a vertex without a triangle";
        uint32_t side = cornerOf[v], fan = 0;
        do {
            ++fan;
            const uint32_t f = side / 3, entering = (side % 3 + 2) % 3;
            const uint32_t g = mesh.neighbour[f][entering];
            if (g == FileMesh::kNone) break;
            side = 3 * g + mesh.neighbourSide[f][entering];
        } while (side != cornerOf[v] && fan <= cornersAt[v]);
        if (fan != cornersAt[v]) return "has a vertex where two parts touch";
    }

    // Along the border: from a side's end to the border side that leaves it, which cornerOf holds.
    mesh.borderLoop.clear();
    const auto firstBorder =
        std::find_if(mesh.edges.begin(), mesh.edges.end(), [](const FileMesh::Edge& e) { return e.border; });
    if (firstBorder == mesh.edges.end()) return "has no border";
    uint32_t side = 3 * firstBorder->face + firstBorder->side;
    do {
        mesh.borderLoop.push_back(side);
        side = cornerOf[to(side)];
    } while (side != mesh.borderLoop.front() && mesh.borderLoop.size() <= borderSides);
    if (mesh.borderLoop.size() != borderSides) return "has several borders";
    return {};
}

}  // namespace tessera
