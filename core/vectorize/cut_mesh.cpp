// See cut_mesh.h.
#include "core/vectorize/cut_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/mesh/delaunay.h"
#include "core/mesh/jacobian.h"

namespace tessera {

namespace {

// Per pixel the standard deviation of brightness around it, to a power below one: how many points it
// deserves.
std::vector<float> richness(const Image& image) {
    constexpr int kRadius = 6;
    constexpr double kFloor = 1.0 / 255, kPower = .5;
    const int width = image.width(), height = image.height();
    // Sums over a window by running sums: along rows, then along columns.
    const size_t size = image.planeSize();
    std::vector<float> first(size), second(size), density(size);
    parallelFor(size_t(height), 8, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) {
            const size_t row = y * size_t(width);
            const auto value = [&](int x) {
                float sum = 0;
                for (int c = 0; c < 3; ++c) sum += image.plane(c)[row + size_t(x)];
                return double(sum) / 3;
            };
            double a = 0, b = 0;
            for (int x = -kRadius; x < width; ++x) {
                if (x + kRadius < width) {
                    const double v = value(x + kRadius);
                    a += v;
                    b += v * v;
                }
                if (x - kRadius - 1 >= 0) {
                    const double v = value(x - kRadius - 1);
                    a -= v;
                    b -= v * v;
                }
                if (x < 0) continue;
                first[row + size_t(x)] = float(a);
                second[row + size_t(x)] = float(b);
            }
        }
    });
    parallelFor(size_t(width), 64, [&](size_t begin, size_t end) {
        for (size_t x = begin; x < end; ++x) {
            double a = 0, b = 0;
            const auto at = [&](int y) { return size_t(y) * size_t(width) + x; };
            for (int y = -kRadius; y < height; ++y) {
                if (y + kRadius < height) {
                    a += double(first[at(y + kRadius)]);
                    b += double(second[at(y + kRadius)]);
                }
                if (y - kRadius - 1 >= 0) {
                    a -= double(first[at(y - kRadius - 1)]);
                    b -= double(second[at(y - kRadius - 1)]);
                }
                if (y < 0) continue;
                const auto extent = [=](int i, int n) {
                    return std::min(n - 1, i + kRadius) - std::max(0, i - kRadius) + 1;
                };
                const double n = double(extent(int(x), width)) * extent(y, height), mean = a / n;
                const double variance = std::max(0.0, b / n - mean * mean);
                density[at(y)] = float(std::pow(variance + kFloor * kFloor, .5 * kPower));
            }
        }
    });
    return density;
}

// Pixels too near to a feature for a point of their own: beside the curve, or between it and its chord.
std::vector<uint8_t> keptFree(const FeatureNetwork& network, int width, int height) {
    constexpr double kClearance = 1.6, kStep = .5;
    std::vector<uint8_t> taken(size_t(width) * size_t(height), 0);
    const auto mark = [&](glm::dvec2 p) {
        const int x0 = std::max(0, int(p.x - kClearance)), x1 = std::min(width - 1, int(p.x + kClearance));
        const int y0 = std::max(0, int(p.y - kClearance)), y1 = std::min(height - 1, int(p.y + kClearance));
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const double dx = x + .5 - p.x, dy = y + .5 - p.y;
                if (dx * dx + dy * dy < kClearance * kClearance)
                    taken[size_t(y) * size_t(width) + size_t(x)] = 1;
            }
    };
    for (const FeatureSegment& s : network.segments) {
        const BezierCurve curve = curveOf(network, s);
        const int steps = std::max(2, int(curve.length() / kStep));
        for (int i = 0; i <= steps; ++i) {
            const double t = double(i) / steps;
            const glm::dvec2 on = curve.at(t), off = curve.p[0] + t * (curve.p[3] - curve.p[0]) - on;
            const int across = 1 + int(std::sqrt(off.x * off.x + off.y * off.y) / kStep);
            for (int k = 0; k <= across; ++k) mark(on + double(k) / across * off);
        }
    }
    return taken;
}

// A picture's points by error diffusion (Floyd and Steinberg 1976), over square cells so large that about one
// in sixteen gets a point: over pixels, points this sparse would come in rows of waves.
class PointScatter {
  public:
    // Pixels that are `taken` get none.
    PointScatter(std::vector<float> density, const std::vector<uint8_t>& taken, int width, int height,
                 double wanted)
        : mDensity(std::move(density)),
          mWidth(width),
          mHeight(height),
          mWanted(wanted),
          mCell(std::max(1, int(std::sqrt(double(width) * height / std::max(1.0, wanted)) / kCellsApart))),
          mColumns((width + mCell - 1) / mCell),
          mRows((height + mCell - 1) / mCell),
          mSums(size_t(mColumns) * size_t(mRows), 0) {
        for (size_t i = 0; i < mDensity.size(); ++i)
            if (taken[i]) mDensity[i] = 0;
        for (int y = 0; y < mHeight; ++y)
            for (int x = 0; x < mWidth; ++x)
                mSums[size_t(y / mCell) * size_t(mColumns) + size_t(x / mCell)] += double(at(x, y));
    }

    // About as many as are wanted.
    std::vector<LatticePoint> points() const {
        constexpr int kTries = 3;
        constexpr double kOff = .03;
        const double sum = std::accumulate(mSums.begin(), mSums.end(), 0.0);
        if (sum <= 0) return {};
        double scale = mWanted / sum;
        std::vector<size_t> cells = diffused(scale);
        for (int i = 1; i < kTries && std::abs(double(cells.size()) - mWanted) > kOff * mWanted + 1; ++i) {
            scale *= mWanted / std::max(1.0, double(cells.size()));
            cells = diffused(scale);
        }
        std::vector<LatticePoint> points;
        for (const size_t cell : cells) points.push_back(pointIn(cell));
        return points;
    }

  private:
    static constexpr double kCellsApart = 4;

    float at(int x, int y) const { return mDensity[size_t(y) * size_t(mWidth) + size_t(x)]; }

    // Row by row, back and forth; the cells chosen. The errors that the first row begins with are those of
    // some rows above, mirrored.
    std::vector<size_t> diffused(double scale) const {
        constexpr int kRunIn = 16;
        std::vector<double> row(size_t(mColumns) + 2, 0), next(row);
        std::vector<size_t> chosen;
        for (int y = -std::min(kRunIn, mRows); y < mRows; ++y) {
            const size_t first = size_t(y < 0 ? -1 - y : y) * size_t(mColumns);
            const int step = y % 2 == 0 ? 1 : -1;
            for (int k = 0; k < mColumns; ++k) {
                const auto x = size_t(step > 0 ? k : mColumns - 1 - k), in = x + 1;
                const double deserved = scale * mSums[first + x], value = row[in] + deserved;
                const bool taken = value >= .5 && deserved > 0;
                if (taken && y >= 0) chosen.push_back(first + x);
                const double error = value - (taken ? 1 : 0);
                row[size_t(int(in) + step)] += 7 / 16.0 * error;
                next[size_t(int(in) - step)] += 3 / 16.0 * error;
                next[in] += 5 / 16.0 * error;
                next[size_t(int(in) + step)] += 1 / 16.0 * error;
            }
            // What has left at an end comes back in.
            const size_t last = size_t(mColumns);
            next[1] += next[0] + (step < 0 ? row[0] : 0);
            next[last] += next[last + 1] + (step > 0 ? row[last + 1] : 0);
            row.swap(next);
            std::fill(next.begin(), next.end(), 0);
        }
        return chosen;
    }

    // The middle of the pixel that deserves most.
    LatticePoint pointIn(size_t cell) const {
        const int x0 = int(cell % size_t(mColumns)) * mCell, y0 = int(cell / size_t(mColumns)) * mCell;
        int bestX = x0, bestY = y0;
        for (int y = y0; y < std::min(mHeight, y0 + mCell); ++y)
            for (int x = x0; x < std::min(mWidth, x0 + mCell); ++x)
                if (at(x, y) > at(bestX, bestY)) {
                    bestX = x;
                    bestY = y;
                }
        return {bestX * kLatticePerPixel + kLatticePerPixel / 2,
                bestY * kLatticePerPixel + kLatticePerPixel / 2};
    }

    std::vector<float> mDensity;  // by pixel, 0 where it is taken
    int mWidth, mHeight;
    double mWanted;
    int mCell, mColumns, mRows;  // px; cells
    std::vector<double> mSums;   // by cell
};

// Points on the picture's sides, about as far apart as those inside.
std::vector<LatticePoint> borderPoints(int width, int height, double points) {
    std::vector<LatticePoint> result;
    const double spacing = std::sqrt(double(width) * height / std::max(1.0, points)) * 1.4;
    const int w = width * kLatticePerPixel, h = height * kLatticePerPixel;
    const auto steps = [&](int side) { return std::max(1, int(side / spacing)); };
    for (int i = 1, n = steps(width); i < n; ++i)
        for (const int y : {0, h}) result.push_back({int(int64_t(w) * i / n), y});
    for (int i = 1, n = steps(height); i < n; ++i)
        for (const int x : {0, w}) result.push_back({x, int(int64_t(h) * i / n)});
    return result;
}

bool curved(const CutMesh& cut, HalfedgeId h) {
    return cut.curve(HalfedgeMesh::edge(h)) != nullptr;
}

bool thin(const CutMesh& cut, FaceId f) {
    const auto c = cut.mesh.corners(f);
    return !certifiedIfStraight(cut.positions[c[0].index], cut.positions[c[1].index],
                                cut.positions[c[2].index]);
}

// Takes away the points at the corners of thin faces or, where those are all nodes, the segments there.
// False where there is nothing to take away.
bool removeThin(const CutMesh& cut, FeatureNetwork& network, std::vector<LatticePoint>& points) {
    std::set<LatticePoint> corners;
    for (uint32_t f = 0; f < cut.mesh.faceCapacity(); ++f)
        if (thin(cut, FaceId(f)))
            for (const VertexId v : cut.mesh.corners(FaceId(f))) corners.insert(cut.positions[v.index]);
    if (corners.empty()) return false;
    const auto atThin = [&](LatticePoint p) { return corners.contains(p); };
    if (std::erase_if(points, atThin) > 0) return true;
    return std::erase_if(network.segments, [&](const FeatureSegment& s) {
               return atThin(network.nodes[s.from].position) || atThin(network.nodes[s.to].position);
           }) > 0;
}

// The curves beside patches that have no certified interior point, ascending.
std::vector<uint32_t> unsoundCurves(const CutMesh& cut) {
    std::vector<uint32_t> found;
    for (uint32_t f = 0; f < cut.mesh.faceCapacity(); ++f) {
        const auto sides = cut.mesh.sides(FaceId(f));
        if (std::none_of(sides.begin(), sides.end(), [&](HalfedgeId h) { return curved(cut, h); })) continue;
        if (certifiedDefaultInterior(sideControlPoints(cut, FaceId(f)))) continue;
        for (const HalfedgeId h : sides)
            if (curved(cut, h)) found.push_back(uint32_t(cut.curveOfEdge[HalfedgeMesh::edge(h).index]));
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

// Puts a node into the middle of a segment, each half of its points a cubic of its own. False, with nothing
// changed, where there are too few points between.
bool halve(FeatureNetwork& network, size_t index, double tolerancePx) {
    constexpr uint32_t kLeastSteps = 4;
    FeatureSegment& whole = network.segments[index];
    FeatureChain& chain = network.chains[whole.chain];
    const auto n = uint32_t(chain.points.size());
    const uint32_t steps = (whole.last + n - whole.first) % n;
    if (steps < kLeastSteps) return false;
    const uint32_t middle = (whole.first + steps / 2) % n;
    const glm::dvec2 before = chain.points[middle].position;
    const LatticePoint p = toLattice(before);
    chain.points[middle].position = toPixels(p);
    const auto first = fitChainPart(chain, whole.first, middle, tolerancePx);
    const auto second = fitChainPart(chain, middle, whole.last, tolerancePx);
    if (!first || !second) {
        chain.points[middle].position = before;
        return false;
    }
    const auto inner = [](const BezierCurve& c) {
        return std::array<LatticePoint, 2>{toLattice(c.p[1]), toLattice(c.p[2])};
    };
    const auto node = uint32_t(network.nodes.size());
    const float sigma = .5f * (whole.sigma[0] + whole.sigma[1]);
    network.nodes.push_back({p, FeatureNodeKind::Smooth});
    const FeatureSegment rest{
        node, whole.to, whole.chain, middle, whole.last, inner(*second), {sigma, whole.sigma[1]}};
    whole = {whole.from, node, whole.chain, whole.first, middle, inner(*first), {whole.sigma[0], sigma}};
    network.segments.push_back(rest);
    return true;
}

// Halves the segments that leave a patch beside them without a certificate: halves lie four times as close to
// their chords, between which the triangulation puts its faces. False where there is nothing to halve.
bool halveUnsound(const CutMesh& cut, FeatureNetwork& network, double tolerancePx) {
    bool any = false;
    for (const uint32_t i : unsoundCurves(cut)) {
        const CutCurve& c = cut.curves[i];
        const auto segment = std::find_if(
            network.segments.begin(), network.segments.end(),
            [&](const auto& s) { return s.chain == c.chain && s.first == c.first && s.last == c.last; });
        any = halve(network, size_t(segment - network.segments.begin()), tolerancePx) || any;
    }
    return any;
}

// Where a curve still leaves a patch beside it without a certificate it is pulled toward its chord, in the
// end onto it, which has one: no face is thin. How many were pulled.
size_t straighten(CutMesh& cut) {
    constexpr int kPulls = 4;
    std::vector<int> pulls(cut.curves.size(), 0);
    for (std::vector<uint32_t> bad = unsoundCurves(cut); !bad.empty(); bad = unsoundCurves(cut))
        for (const uint32_t i : bad) {
            CutCurve& c = cut.curves[i];
            ++pulls[i];
            const auto chord = straightControlPoints(cut.positions[c.from.index], cut.positions[c.to.index]);
            for (size_t k = 0; k < 2; ++k)
                c.inner[k] = pulls[i] >= kPulls ? chord[k]
                                                : LatticePoint{(c.inner[k].x + chord[k].x) / 2,
                                                               (c.inner[k].y + chord[k].y) / 2};
        }
    return size_t(std::count_if(pulls.begin(), pulls.end(), [](int n) { return n > 0; }));
}

VertexKind kindOf(FeatureNodeKind kind) {
    return kind == FeatureNodeKind::Smooth ? VertexKind::Feature : VertexKind::FeatureEnd;
}

// The constrained triangulation, with curves as they are; `refused` counts segments left out.
CutMesh triangulate(const FeatureNetwork& network, const std::vector<LatticePoint>& points, size_t& refused,
                    Progress& progress) {
    CutMesh cut;
    cut.width = network.width;
    cut.height = network.height;
    cut.chains = network.chains;
    const LatticePoint extent{cut.width * kLatticePerPixel, cut.height * kLatticePerPixel};
    Delaunay delaunay(extent);
    std::vector<bool> used(network.nodes.size(), false);
    for (const FeatureSegment& s : network.segments) used[s.from] = used[s.to] = true;
    std::vector<VertexId> vertexOfNode(network.nodes.size());
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i]) vertexOfNode[i] = delaunay.insert(network.nodes[i].position);
    refused = 0;
    for (const FeatureSegment& s : network.segments) {
        const VertexId a = vertexOfNode[s.from], b = vertexOfNode[s.to];
        if (a.valid() && b.valid() && a != b && delaunay.constrain(a, b).valid())
            cut.curves.push_back({a, b, s.chain, s.first, s.last, s.inner, s.sigma});
        else
            ++refused;
    }
    for (size_t i = 0; i < points.size(); ++i) {
        if (i % 1024 == 0 && !progress.step(.3 + .6 * double(i) / double(points.size()))) return cut;
        delaunay.insert(points[i]);
    }
    cut.mesh = delaunay.mesh();
    cut.positions = delaunay.positions();
    for (const LatticePoint p : cut.positions) {
        const bool x = p.x == 0 || p.x == extent.x, y = p.y == 0 || p.y == extent.y;
        cut.kinds.push_back(x && y ? VertexKind::Corner : x || y ? VertexKind::Border : VertexKind::Interior);
    }
    for (size_t i = 0; i < network.nodes.size(); ++i)
        if (vertexOfNode[i].valid() && cut.kinds[vertexOfNode[i].index] != VertexKind::Corner)
            cut.kinds[vertexOfNode[i].index] = kindOf(network.nodes[i].kind);
    cut.curveOfEdge.assign(cut.mesh.edgeCapacity(), -1);
    for (size_t i = 0; i < cut.curves.size(); ++i)
        cut.curveOfEdge[HalfedgeMesh::edge(cut.mesh.find(cut.curves[i].from, cut.curves[i].to)).index] =
            int32_t(i);
    return cut;
}

}  // namespace

std::array<LatticePoint, 4> CutCurve::controlPoints(VertexId a,
                                                    const std::vector<LatticePoint>& positions) const {
    if (a == from) return {positions[from.index], inner[0], inner[1], positions[to.index]};
    return {positions[to.index], inner[1], inner[0], positions[from.index]};
}

Result<CutMesh> buildCutMesh(const Image& sharp, const FeatureNetwork& network, size_t faces,
                             const VectorizeSettings& settings, StageReport& report, Progress& progress) {
    constexpr int kHalvings = 4;
    const int width = sharp.width(), height = sharp.height();
    FeatureNetwork halved = network;
    std::vector<LatticePoint> points = borderPoints(width, height, double(faces) / 2);
    // Euler: of V vertices, B of them on the border, there are 2 V - B - 2 faces.
    constexpr int kCorners = 4;
    const double onBorder = double(points.size()) + kCorners;
    const double wanted = std::max(0.0, (double(faces) + 2 - onBorder) / 2 - double(network.nodes.size()));
    const auto inside =
        PointScatter(richness(sharp), keptFree(network, width, height), width, height, wanted).points();
    points.insert(points.end(), inside.begin(), inside.end());
    size_t refused = 0;
    CutMesh cut;
    for (int halvings = 0;;) {
        cut = triangulate(halved, points, refused, progress);
        if (!progress.step(.9)) return stopped();
        if (removeThin(cut, halved, points)) continue;  // each time there is less
        if (halvings++ == kHalvings || !halveUnsound(cut, halved, settings.featureTolerancePx)) break;
    }
    const size_t straightened = straighten(cut);
    report.figures = {{"faces", double(cut.mesh.faceCount())},
                      {"feature edges", double(cut.curves.size())},
                      {"feature edges refused", double(refused)},
                      {"feature edges straightened", double(straightened)}};
    return cut;
}

LatticeTriangle sideControlPoints(const CutMesh& cut, FaceId f) {
    LatticeTriangle t;
    size_t s = 0;
    for (const HalfedgeId h : cut.mesh.sides(f)) {
        const VertexId a = cut.mesh.origin(h), b = cut.mesh.target(h);
        const LatticePoint pa = cut.positions[a.index], pb = cut.positions[b.index];
        const auto inner = straightControlPoints(pa, pb);
        std::array<LatticePoint, 4> side{pa, inner[0], inner[1], pb};
        if (const CutCurve* c = cut.curve(HalfedgeMesh::edge(h))) side = c->controlPoints(a, cut.positions);
        for (size_t i = 0; i < 3; ++i) t.p[3 * s + i] = side[i];
        ++s;
    }
    return t;
}

PatchMesh toPatchMesh(const CutMesh& cut, int channels) {
    const auto compact = cut.mesh.compacted();
    std::vector<LatticePoint> positions;
    for (const VertexId v : compact.oldVertex) positions.push_back(cut.positions[v.index]);
    PatchMesh mesh(cut.width, cut.height, channels, compact.mesh, positions);
    for (uint32_t e = 0; e < compact.oldEdge.size(); ++e) {
        const CutCurve* c = cut.curve(compact.oldEdge[e]);
        if (!c) continue;
        const VertexId from = compact.oldVertex[compact.mesh.origin(HalfedgeMesh::halfedge(EdgeId(e))).index];
        const auto p = c->controlPoints(from, cut.positions);
        auto sigma = c->sigma;
        if (from != c->from) std::swap(sigma[0], sigma[1]);
        mesh.setCurve(EdgeId(e), {p[1], p[2], true, sigma});
    }
    mesh.forEachPatch([&](PatchId p) {
        const auto interior = certifiedDefaultInterior(mesh.controlPoints(p));
        TESSERA_CHECK(interior);
        mesh.setInterior(p, *interior);
    });
    return mesh;
}

}  // namespace tessera
