// See refine.h.
#include "core/vectorize/refine.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace tessera {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kSinMinAngle = .1391731;  // 8 degrees

}  // namespace

Refiner::Refiner(WorkingMesh& work, const PolynomialFit& fit) : m(work), mFit(fit) {
    mError.assign(m.mesh.faceCapacity(), 0);
    parallelFor(mError.size(), 64, [&](size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f)
            if (m.mesh.alive(FaceId(uint32_t(f)))) updateFace(FaceId(uint32_t(f)));
    });
}

double Refiner::totalError() const {
    double sum = 0;
    for (uint32_t f = 0; f < mError.size(); ++f)
        if (m.mesh.alive(FaceId(f))) sum += mError[f];
    return sum;
}

double Refiner::triangleError(LatticePoint a, LatticePoint b, LatticePoint c) const {
    static const double grow = getenv("GROW") ? atof(getenv("GROW")) : 0;
    std::array<glm::dvec2, 3> t{toPixels(a), toPixels(b), toPixels(c)}, g = t;
    if (grow > 0)
        for (size_t k = 0; k < 3; ++k) {
            glm::dvec2 u = t[(k + 1) % 3] - t[k], v = t[(k + 2) % 3] - t[k];
            u /= std::sqrt(u.x * u.x + u.y * u.y);
            v /= std::sqrt(v.x * v.x + v.y * v.y);
            const double s = cross(u, v);  // sine of the angle
            g[k] -= (u + v) * std::min(grow / std::max(s, 1e-6), 2.0 * grow);
        }
    return mFit.error(g);
}

bool Refiner::wellShaped(LatticePoint a, LatticePoint b, LatticePoint c) const {
    const int64_t area2 = cross(b - a, c - a);
    if (area2 <= 0) return false;
    const auto squared = [](LatticePoint d) { return double(d.x) * d.x + double(d.y) * d.y; };
    double l[3] = {squared(b - a), squared(c - b), squared(a - c)};
    std::sort(l, l + 3);
    return double(area2) * double(area2) >= kSinMinAngle * kSinMinAngle * l[1] * l[2];
}

void Refiner::updateFace(FaceId f) {
    const auto c = m.mesh.corners(f);
    mError[f.index] = triangleError(at(c[0]), at(c[1]), at(c[2]));
}

Refiner::Option Refiner::bestCollapse(VertexId u) const {
    const VertexKind kind = m.kinds[u.index];
    Option best{kNever, {}};
    if (kind == VertexKind::Corner) return best;
    double before = 0;
    m.mesh.forEachOutgoing(u, [&](HalfedgeId h) {
        if (m.mesh.face(h).valid()) before += mError[m.mesh.face(h).index];
    });
    m.mesh.forEachOutgoing(u, [&](HalfedgeId h) {
        const VertexId v = m.mesh.target(h);
        if (kind == VertexKind::Border && !m.mesh.onBorder(HalfedgeMesh::edge(h))) return;
        if (!m.mesh.canCollapse(h)) return;
        if (kind == VertexKind::Border) {  // stays on its side of the picture
            bool straight = true;
            m.mesh.forEachOutgoing(u, [&](HalfedgeId o) {
                if (m.mesh.onBorder(HalfedgeMesh::edge(o)) && o != h)
                    straight = straight && cross(at(v) - at(u), at(m.mesh.target(o)) - at(u)) == 0;
            });
            if (!straight) return;
        }
        bool valid = true;
        const auto forFaces = [&](auto&& visit) {
            m.mesh.forEachOutgoing(u, [&](HalfedgeId o) {
                if (!valid || !m.mesh.face(o).valid()) return;
                const VertexId a = m.mesh.target(o), b = m.mesh.target(m.mesh.next(o));
                if (a == v || b == v) return;
                visit(a, b);
            });
        };
        forFaces([&](VertexId a, VertexId b) { valid = wellShaped(at(v), at(a), at(b)); });
        if (!valid) return;
        double after = 0;
        forFaces([&](VertexId a, VertexId b) {
            after += triangleError(at(v), at(a), at(b));
            valid = after - before < best.gain;
        });
        if (valid) best = {after - before, h};
    });
    return best;
}

bool Refiner::collapseTo(size_t faces, Progress& progress) {
    std::vector<Option> options(m.mesh.vertexCapacity());
    std::vector<VertexId> dirty;
    for (uint32_t v = 0; v < options.size(); ++v)
        if (m.mesh.alive(VertexId(v))) dirty.push_back(VertexId(v));
    std::vector<uint8_t> touched(m.mesh.faceCapacity());
    while (m.mesh.faceCount() > faces) {
        if (progress.stopRequested()) return false;
        parallelFor(dirty.size(), 8, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) options[dirty[i].index] = bestCollapse(dirty[i]);
        });
        std::vector<VertexId> order;
        for (uint32_t v = 0; v < options.size(); ++v)
            if (m.mesh.alive(VertexId(v)) && options[v].gain < kNever) order.push_back(VertexId(v));
        if (order.empty()) return true;
        std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
            const double ga = options[a.index].gain, gb = options[b.index].gain;
            return ga != gb ? ga < gb : a < b;
        });
        const size_t batch =
            std::max<size_t>(1, std::min((m.mesh.faceCount() - faces + 1) / 2, order.size() / 16 + 1));
        std::fill(touched.begin(), touched.end(), 0);
        dirty.clear();
        std::vector<FaceId> changed;
        size_t done = 0;
        for (const VertexId u : order) {
            if (done >= batch) break;
            bool free = true;
            m.mesh.forEachOutgoing(u, [&](HalfedgeId o) {
                if (m.mesh.face(o).valid()) free = free && !touched[m.mesh.face(o).index];
            });
            const HalfedgeId h = options[u.index].halfedge;
            if (!free || !m.mesh.canCollapse(h)) {
                dirty.push_back(u);
                continue;
            }
            const VertexId v = m.mesh.target(h);
            std::vector<VertexId> ring;
            std::vector<FaceId> star;
            m.mesh.forEachOutgoing(u, [&](HalfedgeId o) {
                ring.push_back(m.mesh.target(o));
                if (m.mesh.face(o).valid()) star.push_back(m.mesh.face(o));
            });
            m.mesh.collapse(h);
            for (const FaceId f : star)
                if (m.mesh.alive(f)) {
                    touched[f.index] = 1;
                    changed.push_back(f);
                }
            for (const VertexId r : ring) dirty.push_back(r);
            ++done;
        }
        parallelFor(changed.size(), 8, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) updateFace(changed[i]);
        });
        std::sort(dirty.begin(), dirty.end());
        dirty.erase(std::unique(dirty.begin(), dirty.end()), dirty.end());
        std::erase_if(dirty, [&](VertexId v) { return !m.mesh.alive(v); });
        if (done == 0) return true;
    }
    return true;
}

Refiner::Option Refiner::flipGain(EdgeId e) const {
    Option none{kNever, {}};
    if (!m.mesh.canFlip(e)) return none;
    const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
    const LatticePoint a = at(m.mesh.origin(h)), b = at(m.mesh.origin(t)),
                       c = at(m.mesh.target(m.mesh.next(h))), d = at(m.mesh.target(m.mesh.next(t)));
    if (!wellShaped(c, d, b) || !wellShaped(d, c, a)) return none;
    const double before = mError[m.mesh.face(h).index] + mError[m.mesh.face(t).index];
    double after = triangleError(c, d, b);
    if (after >= before) return none;
    after += triangleError(d, c, a);
    return {after - before, h};
}

size_t Refiner::flipPass() {
    std::vector<Option> options(m.mesh.edgeCapacity());
    parallelFor(options.size(), 32, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e)
            options[e] =
                m.mesh.alive(EdgeId(uint32_t(e))) ? flipGain(EdgeId(uint32_t(e))) : Option{kNever, {}};
    });
    std::vector<uint32_t> order;
    for (uint32_t e = 0; e < options.size(); ++e)
        if (options[e].gain < -1e-9) order.push_back(e);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return options[a].gain != options[b].gain ? options[a].gain < options[b].gain : a < b;
    });
    std::vector<uint8_t> touched(m.mesh.faceCapacity(), 0);
    size_t done = 0;
    for (const uint32_t e : order) {
        const HalfedgeId h = HalfedgeMesh::halfedge(EdgeId(e));
        const FaceId f = m.mesh.face(h), g = m.mesh.face(HalfedgeMesh::twin(h));
        if (touched[f.index] || touched[g.index] || !m.mesh.canFlip(EdgeId(e))) continue;
        m.mesh.flip(EdgeId(e));
        touched[f.index] = touched[g.index] = 1;
        updateFace(f);
        updateFace(g);
        ++done;
    }
    return done;
}

LatticePoint Refiner::middle(EdgeId e) const {
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    const LatticePoint s = at(m.mesh.origin(h)) + at(m.mesh.target(h));
    return {s.x / 2, s.y / 2};
}

double Refiner::splitGain(EdgeId e) const {
    const HalfedgeId h = HalfedgeMesh::halfedge(e);
    const LatticePoint p = middle(e);
    double before = 0, after = 0;
    for (const HalfedgeId s : {h, HalfedgeMesh::twin(h)}) {
        if (!m.mesh.face(s).valid()) continue;
        const LatticePoint a = at(m.mesh.origin(s)), b = at(m.mesh.target(s)),
                           c = at(m.mesh.target(m.mesh.next(s)));
        if (!wellShaped(a, p, c) || !wellShaped(p, b, c)) return kNever;
        before += mError[m.mesh.face(s).index];
        after += triangleError(a, p, c) + triangleError(p, b, c);
    }
    return after - before;
}

void Refiner::splitTo(size_t faces) {
    std::vector<double> gains(m.mesh.edgeCapacity(), kNever);
    parallelFor(gains.size(), 32, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e)
            if (m.mesh.alive(EdgeId(uint32_t(e)))) gains[e] = splitGain(EdgeId(uint32_t(e)));
    });
    std::vector<uint32_t> order;
    for (uint32_t e = 0; e < gains.size(); ++e)
        if (gains[e] < 0) order.push_back(e);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return gains[a] != gains[b] ? gains[a] < gains[b] : a < b; });
    std::vector<uint8_t> touched(m.mesh.faceCapacity(), 0);
    std::vector<FaceId> changed;
    for (const uint32_t e : order) {
        if (m.mesh.faceCount() >= faces) break;
        const HalfedgeId h = HalfedgeMesh::halfedge(EdgeId(e));
        bool free = true;
        for (const HalfedgeId s : {h, HalfedgeMesh::twin(h)})
            if (m.mesh.face(s).valid()) free = free && !touched[m.mesh.face(s).index];
        if (!free) continue;
        const bool border = m.mesh.onBorder(EdgeId(e));
        const LatticePoint p = middle(EdgeId(e));
        const VertexId v = m.mesh.split(EdgeId(e));
        m.positions.push_back(p);
        m.kinds.push_back(border ? VertexKind::Border : VertexKind::Interior);
        touched.resize(m.mesh.faceCapacity(), 0);
        m.mesh.forEachOutgoing(v, [&](HalfedgeId o) {
            if (!m.mesh.face(o).valid()) return;
            touched[m.mesh.face(o).index] = 1;
            changed.push_back(m.mesh.face(o));
        });
    }
    mError.resize(m.mesh.faceCapacity(), 0);
    parallelFor(changed.size(), 8, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) updateFace(changed[i]);
    });
}

bool Refiner::tryMove(VertexId v, double step) {
    static constexpr int kDirections[8][2] = {{1, 0}, {0, 1},  {-1, 0},  {0, -1},
                                              {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    double before = 0, area = 0;
    size_t count = 0;
    m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (!m.mesh.face(h).valid()) return;
        before += mError[m.mesh.face(h).index];
        area += double(cross(at(m.mesh.target(h)) - at(v), at(m.mesh.target(m.mesh.next(h))) - at(v)));
        ++count;
    });
    if (before <= 0) return false;
    const double length = step * std::sqrt(area / double(count));
    const LatticePoint from = at(v);
    double best = before * (1 - 1e-6);
    LatticePoint to = from;
    for (const auto& d : kDirections) {
        const double norm = d[0] && d[1] ? .70710678 : 1;
        const LatticePoint p{from.x + int32_t(std::lround(length * norm * d[0])),
                             from.y + int32_t(std::lround(length * norm * d[1]))};
        if (p == from) continue;
        if (m.kinds[v.index] == VertexKind::Border) {
            bool along = true;
            m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
                if (m.mesh.onBorder(HalfedgeMesh::edge(h)))
                    along = along && cross(p - from, at(m.mesh.target(h)) - from) == 0;
            });
            if (!along) continue;
        }
        bool valid = true;
        m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
            if (valid && m.mesh.face(h).valid())
                valid = wellShaped(p, at(m.mesh.target(h)), at(m.mesh.target(m.mesh.next(h))));
        });
        if (!valid) continue;
        double after = 0;
        m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
            if (!valid || !m.mesh.face(h).valid()) return;
            after += triangleError(p, at(m.mesh.target(h)), at(m.mesh.target(m.mesh.next(h))));
            valid = after < best;
        });
        if (!valid) continue;
        best = after;
        to = p;
    }
    if (to == from) return false;
    m.positions[v.index] = to;
    m.mesh.forEachOutgoing(v, [&](HalfedgeId h) {
        if (m.mesh.face(h).valid()) updateFace(m.mesh.face(h));
    });
    return true;
}

size_t Refiner::movePass(double step) {
    std::vector<uint8_t> colour(m.mesh.vertexCapacity(), 0);
    std::vector<std::vector<VertexId>> classes;
    for (uint32_t v = 0; v < colour.size(); ++v) {
        if (!m.mesh.alive(VertexId(v))) continue;
        if (m.kinds[v] != VertexKind::Interior && m.kinds[v] != VertexKind::Border) continue;
        uint64_t used = 0;
        m.mesh.forEachOutgoing(VertexId(v), [&](HalfedgeId h) {
            const uint8_t c = colour[m.mesh.target(h).index];
            if (c) used |= uint64_t(1) << (c - 1);
        });
        size_t c = 0;
        while (used >> c & 1) ++c;
        colour[v] = uint8_t(c + 1);
        if (classes.size() <= c) classes.resize(c + 1);
        classes[c].push_back(VertexId(v));
    }
    std::vector<uint8_t> moved(colour.size(), 0);
    for (const auto& vertices : classes)
        parallelFor(vertices.size(), 4, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) moved[vertices[i].index] = tryMove(vertices[i], step);
        });
    return size_t(std::accumulate(moved.begin(), moved.end(), 0));
}

}  // namespace tessera
