// See mesh_validate.h.
#include "core/mesh/mesh_validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/jacobian.h"

namespace tessera {

namespace {

std::string name(const char* kind, uint32_t index) {
    return std::string(kind) + " " + std::to_string(index);
}

class Findings {
  public:
    explicit Findings(MeshValidation& result) : mResult(result) {}
    void add(const std::string& what) {
        ++mResult.violationCount;
        if (mResult.violations.size() < kMaxViolations) mResult.violations.push_back(what);
    }

  private:
    MeshValidation& mResult;
};

// Border edges run straight along the picture's sides, and the four corners of the picture are vertices.
void checkBorder(const PatchMesh& mesh, Findings& findings) {
    const HalfedgeMesh& c = mesh.connectivity();
    const int32_t right = mesh.width() * kLatticePerPixel, bottom = mesh.height() * kLatticePerPixel;
    int corners = 0;
    size_t borderEdges = 0;
    HalfedgeId anyBorder;
    mesh.forEachVertex([&](VertexId v) {
        const LatticePoint p = mesh.position(v);
        if (p.x < 0 || p.y < 0 || p.x > right || p.y > bottom)
            findings.add(name("vertex", v.index) + " lies outside the picture");
        corners += (p.x == 0 || p.x == right) && (p.y == 0 || p.y == bottom);
    });
    if (corners != 4)
        findings.add(std::to_string(corners) + " vertices at the picture's corners in place of 4");
    mesh.forEachEdge([&](EdgeId e) {
        if (!c.onBorder(e)) return;
        ++borderEdges;
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        anyBorder = c.face(h).valid() ? HalfedgeMesh::twin(h) : h;
        const auto p = mesh.controlPoints(h);
        const auto all = [&](auto&& on) { return std::all_of(p.begin(), p.end(), on); };
        const bool straight = all([&](LatticePoint q) { return q.x == 0; }) ||
                              all([&](LatticePoint q) { return q.x == right; }) ||
                              all([&](LatticePoint q) { return q.y == 0; }) ||
                              all([&](LatticePoint q) { return q.y == bottom; });
        if (!straight) findings.add(name("border edge", e.index) + " leaves the picture's side");
        if (mesh.curve(e).feature) findings.add(name("border edge", e.index) + " is marked as a feature");
    });
    if (!anyBorder.valid()) {
        findings.add("the mesh has no border");
        return;
    }
    size_t loop = 0;
    HalfedgeId h = anyBorder;
    do {
        h = c.next(h);
        ++loop;
    } while (h != anyBorder && loop <= borderEdges);
    if (loop != borderEdges) findings.add("the border is not one loop");
}

void checkSplines(const PatchMesh& mesh, Findings& findings) {
    mesh.forEachPatch([&](PatchId p) {
        const PatchSpline& s = mesh.spline(p);
        bool sound = s.coefficients.size() == s.offset(mesh.channels());
        for (int c = 0; c < mesh.channels(); ++c) {
            const int terms = s.terms[size_t(c)];
            sound = sound && terms <= int(s.centreCount());
            sound = sound && (terms == 0 || terms >= 3);
        }
        sound = sound && std::all_of(s.coefficients.begin(), s.coefficients.end(),
                                     [](float k) { return std::isfinite(k); });
        if (!sound) {
            findings.add(name("patch", p.index) + " has a colour spline of the wrong size or not finite");
            return;
        }
        for (int c = 0; c < mesh.channels(); ++c) {
            glm::dvec3 sum(0);
            double size = 0;
            for (int i = 0; i < s.terms[size_t(c)]; ++i) {
                const double alpha = double(s.coefficients[s.offset(c) + 3 + size_t(i)]);
                sum += alpha * glm::dvec3(1, s.centre(i));
                size += std::abs(alpha);
            }
            constexpr double kRounding = 1e-5;  // coefficients are floats
            if (glm::length(sum) > kRounding * std::max(1.0, size))
                findings.add(name("patch", p.index) + " has a colour spline without its side conditions");
        }
    });
}

void checkSmoothJoins(const PatchMesh& mesh, Findings& findings) {
    for (const SmoothJoin& join : mesh.smoothJoins())
        if (!isSmooth(mesh, join))
            findings.add(name("smooth join at vertex", join.vertex.index) + " is not smooth");
}

void checkBreaks(const PatchMesh& mesh, Findings& findings) {
    mesh.forEachEdge([&](EdgeId e) {
        const EdgeCurve& curve = mesh.curve(e);
        if (curve.colourBreak && (curve.feature || mesh.connectivity().onBorder(e)))
            findings.add(name("edge", e.index) + " is a colour break on a feature or on the border");
    });
}

// Parameters of the point at s along a side of its patch.
Barycentric onSide(const PatchMesh& mesh, HalfedgeId side, double s) {
    const HalfedgeMesh& c = mesh.connectivity();
    const auto sides = c.sides(c.face(side));
    const auto k = int(std::find(sides.begin(), sides.end(), side) - sides.begin());
    Barycentric b(0);
    b[k] = 1 - s;
    b[(k + 1) % 3] = s;
    return b;
}

// The largest difference, over the channels, between the jump across the middle of a blurred edge and the
// jump that should be left there; as a part of the colours where those are above 1.
double wrongJump(const PatchMesh& mesh, const EdgeBlur& blur, const ColourOf& colour, EdgeId e) {
    const HalfedgeId sides[] = {HalfedgeMesh::halfedge(e), HalfedgeMesh::twin(HalfedgeMesh::halfedge(e))};
    const BezierCurve curve = toPixels(mesh.controlPoints(sides[0]));
    const glm::dvec2 middle = curve.at(.5), along = curve.derivative(.5);
    const double speed = glm::length(along);
    if (speed <= 0) return 0;
    constexpr double kHair = 1e-5;  // px; the colours of the patches themselves are taken on the curve
    const glm::dvec2 hair = kHair / speed * glm::dvec2(-along.y, along.x);
    double own[2][kMaxChannels], shown[2][kMaxChannels];
    for (size_t k = 0; k < 2; ++k) {
        const PatchId p = mesh.connectivity().face(sides[k]);
        const Barycentric at = onSide(mesh, sides[k], .5);
        const glm::dvec2 point = k == 0 ? middle + hair : middle - hair;
        std::array<BlurTerm, kMaxBlurTerms> terms;
        if (blur.terms(p, point, terms) > 1) return 0;
        for (int c = 0; c < mesh.channels(); ++c)
            own[k][c] = evaluateSpline(mesh.spline(p), c, domainPoint(at));
        colour(p, at, point, shown[k]);
    }
    const double left = 1 - blur.strength(e, .5);
    double worst = 0, largest = 1;  // colours beyond 1 are rounded as coarsely as they are large
    for (int c = 0; c < mesh.channels(); ++c) {
        worst = std::max(worst, std::abs(shown[0][c] - shown[1][c] - left * (own[0][c] - own[1][c])));
        largest = std::max({largest, std::abs(own[0][c]), std::abs(own[1][c])});
    }
    return worst / largest;
}

// A side as a fine polyline, the same from both of its patches.
constexpr int kFlatSegments = 16;
std::array<glm::dvec2, kFlatSegments + 1> flattened(const PatchMesh& mesh, HalfedgeId h) {
    const EdgeId e = HalfedgeMesh::edge(h);
    const BezierCurve curve = toPixels(mesh.controlPoints(HalfedgeMesh::halfedge(e)));
    std::array<glm::dvec2, kFlatSegments + 1> points;
    for (int i = 0; i <= kFlatSegments; ++i) points[size_t(i)] = curve.at(double(i) / kFlatSegments);
    if (h != HalfedgeMesh::halfedge(e)) std::reverse(points.begin(), points.end());
    return points;
}

// How often each pixel centre lies in a patch by the winding number of the patch's outline; a patch that
// winds around a centre backwards or twice counts as two.
std::vector<uint8_t> coverage(const PatchMesh& mesh) {
    const int width = mesh.width(), height = mesh.height();
    std::vector<uint8_t> count(size_t(width) * size_t(height), 0);
    std::vector<int> steps;
    mesh.forEachPatch([&](PatchId p) {
        std::vector<std::pair<glm::dvec2, glm::dvec2>> segments;  // from, to
        glm::dvec2 lo(1e300), hi(-1e300);
        for (const HalfedgeId side : mesh.connectivity().sides(p)) {
            const auto points = flattened(mesh, side);
            for (size_t i = 0; i + 1 < points.size(); ++i) {
                segments.emplace_back(points[i], points[i + 1]);
                lo = glm::min(lo, points[i]);
                hi = glm::max(hi, points[i]);
            }
        }
        // Pixel (x, y) has its centre at + .5; a segment crosses the rows whose centres lie in [top, bottom).
        const int x0 = std::max(0, int(std::ceil(lo.x - .5))),
                  x1 = std::min(width, int(std::ceil(hi.x - .5)));
        const int y0 = std::max(0, int(std::ceil(lo.y - .5))),
                  y1 = std::min(height, int(std::ceil(hi.y - .5)));
        if (x0 >= x1 || y0 >= y1) return;
        const auto stride = size_t(x1 - x0 + 1);
        steps.assign(stride * size_t(y1 - y0), 0);
        for (const auto& [from, to] : segments) {
            const bool down = from.y < to.y;
            // The same arithmetic from both sides of an edge.
            const glm::dvec2 a = down ? from : to, b = down ? to : from;
            const int top = std::max(y0, int(std::ceil(a.y - .5))),
                      bottom = std::min(y1, int(std::ceil(b.y - .5)));
            for (int y = top; y < bottom; ++y) {
                const double x = a.x + (y + .5 - a.y) / (b.y - a.y) * (b.x - a.x);
                const int first = std::clamp(int(std::ceil(x - .5)), x0, x1);
                steps[size_t(y - y0) * stride + size_t(first - x0)] += down ? -1 : 1;
            }
        }
        for (int y = y0; y < y1; ++y) {
            int winding = 0;
            for (int x = x0; x < x1; ++x) {
                winding += steps[size_t(y - y0) * stride + size_t(x - x0)];
                if (winding == 0) continue;
                uint8_t& c = count[size_t(y) * size_t(width) + size_t(x)];
                c = uint8_t(std::min(255, c + (winding == 1 ? 1 : 2)));
            }
        }
    });
    return count;
}

}  // namespace

bool isSmooth(const PatchMesh& mesh, const SmoothJoin& join) {
    const HalfedgeMesh& c = mesh.connectivity();
    if (!c.alive(join.vertex) || !c.alive(join.first) || !c.alive(join.second)) return false;
    glm::dvec2 handles[2];
    const EdgeId edges[2] = {join.first, join.second};
    for (int k = 0; k < 2; ++k) {
        HalfedgeId h = HalfedgeMesh::halfedge(edges[k]);
        if (c.origin(h) != join.vertex) h = HalfedgeMesh::twin(h);
        if (c.origin(h) != join.vertex) return false;
        const auto p = toPixels(mesh.controlPoints(h));
        handles[k] = p.p[1] - p.p[0];
    }
    // Each handle's end may be off by half a lattice step along either axis.
    const double shorter = std::min(glm::length(handles[0]), glm::length(handles[1]));
    const double slack = 2.0 / kLatticePerPixel / std::max(shorter, 1e-9);
    const double sine = std::abs(cross(handles[0], handles[1])) /
                        std::max(glm::length(handles[0]) * glm::length(handles[1]), 1e-12);
    return glm::dot(handles[0], handles[1]) < 0 && sine <= slack;
}

std::vector<std::string> connectivityViolations(const HalfedgeMesh& mesh) {
    std::vector<std::string> found;
    const auto require = [&](bool sound, const char* kind, uint32_t index, const char* what) {
        if (!sound && found.size() < kMaxViolations) found.push_back(name(kind, index) + " " + what);
        return sound;
    };
    size_t edges = 0, faces = 0, vertices = 0;
    std::vector<uint32_t> outgoing(mesh.vertexCapacity(), 0);
    for (uint32_t i = 0; i < 2 * mesh.edgeCapacity(); ++i) {
        const HalfedgeId h(i);
        if (!mesh.alive(HalfedgeMesh::edge(h))) continue;
        edges += (i & 1) == 0;
        const HalfedgeId n = mesh.next(h);
        if (!require(n.valid() && n.index < 2 * mesh.edgeCapacity() && mesh.alive(HalfedgeMesh::edge(n)),
                     "halfedge", i, "has no successor"))
            continue;
        require(mesh.origin(n) == mesh.target(h), "halfedge", i, "does not end where its successor begins");
        require(mesh.face(n) == mesh.face(h), "halfedge", i, "has a successor in another face");
        require(mesh.origin(h) != mesh.target(h), "halfedge", i, "joins a vertex to itself");
        require(mesh.alive(mesh.origin(h)), "halfedge", i, "leaves a deleted vertex");
        ++outgoing[mesh.origin(h).index];
        if (mesh.face(h).valid())
            require(mesh.alive(mesh.face(h)) && mesh.next(mesh.next(n)) == h, "halfedge", i,
                    "is no side of a triangle");
        else
            require(mesh.face(HalfedgeMesh::twin(h)).valid(), "halfedge", i, "has no face on either side");
    }
    for (uint32_t i = 0; i < mesh.faceCapacity(); ++i) {
        if (!mesh.alive(FaceId(i))) continue;
        ++faces;
        require(mesh.face(mesh.halfedge(FaceId(i))) == FaceId(i), "face", i,
                "is not the face of its halfedge");
    }
    if (!found.empty()) return found;
    for (uint32_t i = 0; i < mesh.vertexCapacity(); ++i) {
        const VertexId v(i);
        if (!mesh.alive(v)) continue;
        ++vertices;
        if (!require(mesh.origin(mesh.halfedge(v)) == v, "vertex", i, "is not the origin of its halfedge"))
            continue;
        uint32_t around = 0, outside = 0;
        std::vector<VertexId> neighbours;
        HalfedgeId h = mesh.halfedge(v);
        do {
            neighbours.push_back(mesh.target(h));
            outside += !mesh.face(h).valid();
            h = mesh.rotate(h);
        } while (h != mesh.halfedge(v) && ++around <= outgoing[i]);
        require(neighbours.size() == outgoing[i], "vertex", i, "has edges that do not go around it");
        require(outside <= 1, "vertex", i, "touches the border twice");
        require(outside == 0 || mesh.onBorder(v), "vertex", i, "does not know that it is on the border");
        std::sort(neighbours.begin(), neighbours.end());
        require(std::adjacent_find(neighbours.begin(), neighbours.end()) == neighbours.end(), "vertex", i,
                "has two edges to one neighbour");
    }
    if (edges != mesh.edgeCount() || faces != mesh.faceCount() || vertices != mesh.vertexCount())
        found.emplace_back("the counts of elements are wrong");
    return found;
}

std::vector<std::string> blurViolations(const PatchMesh& mesh, const EdgeBlur& blur, const ColourOf& colour) {
    std::vector<std::string> found;
    mesh.forEachEdge([&](EdgeId e) {
        const EdgeCurve& curve = mesh.curve(e);
        const auto& [s0, s1] = curve.blurSigma;
        if (!std::isfinite(s0) || !std::isfinite(s1) || s0 < 0 || s1 < 0)
            found.push_back(name("edge", e.index) + " has a blur that is negative or not finite");
        else if (!curve.feature && (s0 > 0 || s1 > 0))
            found.push_back(name("edge", e.index) + " has a blur and is no feature");
    });
    if (!found.empty()) return found;
    mesh.forEachEdge([&](EdgeId e) {
        // Beside a thinner blur a hair's breadth counts.
        constexpr float kThinnest = .05F;
        const EdgeCurve& curve = mesh.curve(e);
        if (!curve.feature || mesh.connectivity().onBorder(e)) return;
        if (curve.blurSigma[0] + curve.blurSigma[1] < 2 * kThinnest) return;
        constexpr double kTolerance = 1e-3;
        if (!(wrongJump(mesh, blur, colour, e) <= kTolerance))
            found.push_back(name("edge", e.index) + " has a blur that leaves a jump of colour");
    });
    return found;
}

MeshValidation validate(const PatchMesh& mesh) {
    MeshValidation result;
    Findings findings(result);
    for (const std::string& violation : connectivityViolations(mesh.connectivity())) findings.add(violation);
    if (!result.valid()) return result;  // the rest walks the connectivity

    checkBorder(mesh, findings);
    checkSplines(mesh, findings);
    checkSmoothJoins(mesh, findings);
    checkBreaks(mesh, findings);
    const EdgeBlur blur(mesh);
    const auto colour = [&](PatchId p, const Barycentric& at, glm::dvec2 point, double* out) {
        blurredColour(mesh, blur, p, at, point, out);
    };
    for (const std::string& violation : blurViolations(mesh, blur, colour)) findings.add(violation);
    mesh.forEachEdge([&](EdgeId e) {
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        auto back = mesh.controlPoints(HalfedgeMesh::twin(h));
        std::reverse(back.begin(), back.end());
        if (back != mesh.controlPoints(h))
            findings.add(name("edge", e.index) + " differs from its other side");
    });

    result.minBernstein = HUGE_VAL;
    int64_t area20 = 0;
    mesh.forEachPatch([&](PatchId p) {
        const LatticeTriangle t = mesh.controlPoints(p);
        area20 += signedArea20(t);
        const double smallest = minBernstein(t);
        result.minBernstein = std::min(result.minBernstein, smallest);
        if (!certified(t))
            findings.add(name("patch", p.index) + " is not certified free of folds");
        else if (smallest <= 0)
            ++result.subdividedPatches;
    });
    const double pictureArea =
        double(mesh.width()) * double(mesh.height()) * kLatticePerPixel * double(kLatticePerPixel);
    result.areaError = std::abs(double(area20) / 20 - pictureArea) / pictureArea;
    constexpr double kAreaTolerance = 1e-9;
    if (result.areaError > kAreaTolerance) findings.add("the patches' areas do not add up to the picture's");

    for (const uint8_t count : coverage(mesh)) {
        result.uncoveredPixels += count == 0;
        result.doublePixels += count > 1;
    }
    if (result.uncoveredPixels)
        findings.add(std::to_string(result.uncoveredPixels) + " pixel centres are in no patch");
    if (result.doublePixels)
        findings.add(std::to_string(result.doublePixels) + " pixel centres are in several patches");
    return result;
}

namespace {

// Differences of colour with the length that has them.
class SeamLevels {
  public:
    void add(double level, double length) {
        mLevels.emplace_back(level, length);
        mSum += length * level;
        mLength += length;
    }
    double length() const { return mLength; }
    double mean() const { return mLength > 0 ? mSum / mLength : 0; }
    double p95() {
        std::sort(mLevels.begin(), mLevels.end());
        double passed = 0;
        for (const auto& [level, length] : mLevels) {
            passed += length;
            if (passed >= .95 * mLength) return level;
        }
        return mLevels.empty() ? 0 : mLevels.back().first;
    }

  private:
    std::vector<std::pair<double, double>> mLevels;
    double mSum = 0, mLength = 0;
};

}  // namespace

SeamStatistics measureSeams(const PatchMesh& mesh) {
    constexpr int kIntervals = 16;
    SeamLevels seams, breaks;
    const HalfedgeMesh& c = mesh.connectivity();
    const EdgeBlur blur(mesh);
    mesh.forEachEdge([&](EdgeId e) {
        if (mesh.curve(e).feature || c.onBorder(e)) return;
        const HalfedgeId h = HalfedgeMesh::halfedge(e), t = HalfedgeMesh::twin(h);
        const BezierCurve curve = toPixels(mesh.controlPoints(h));
        const double interval = curve.length() / kIntervals;
        for (int i = 0; i <= kIntervals; ++i) {
            const double s = double(i) / kIntervals;
            const double weight = i == 0 || i == kIntervals ? interval / 2 : interval;
            double one[kMaxChannels], other[kMaxChannels];
            blurredColour(mesh, blur, c.face(h), onSide(mesh, h, s), curve.at(s), one);
            blurredColour(mesh, blur, c.face(t), onSide(mesh, t, 1 - s), curve.at(s), other);
            float apart[kMaxChannels];
            float* planes[kMaxChannels];
            for (int k = 0; k < mesh.channels(); ++k) {
                apart[k] = float(one[k] - other[k]);
                planes[k] = &apart[k];
            }
            toWorking(mesh.colourBasis(), planes, 1);
            double difference = 0;
            for (int k = 0; k < mesh.channels(); ++k) difference += std::abs(double(apart[k]));
            (mesh.curve(e).colourBreak ? breaks : seams).add(difference * 255.0 / mesh.channels(), weight);
        }
    });
    return {seams.mean(), seams.p95(), breaks.mean(), breaks.p95(), breaks.length()};
}

}  // namespace tessera
