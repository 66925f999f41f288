// See edit_codec.h.
#include "core/document/edit_codec.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <numeric>

#include "core/document/byte_stream.h"
#include "core/document/colour_codec.h"
#include "core/document/geometry_codec.h"
#include "core/document/site_basis.h"
#include "core/edit/drag_colour.h"

namespace tessera {

namespace {

enum AttributeBits : uint8_t { Hidden = 1, Locked = 2, CutOut = 4 };

const char* const kCutShort = "ends within its numbers";
const char* const kWrongId = "names elements that cannot be";

// A file's id for each of a mesh's; kNone for those that it has not.
template <class Ids, class IndexOf>
std::vector<uint32_t> inverse(const Ids& ids, size_t capacity, IndexOf&& indexOf) {
    std::vector<uint32_t> numbers(capacity, FileMesh::kNone);
    for (uint32_t i = 0; i < ids.size(); ++i) numbers[indexOf(ids[i])] = i;
    return numbers;
}

std::vector<uint32_t> patchNumbers(const FileNumbers& numbers, size_t capacity) {
    return inverse(numbers.patches, capacity, [](PatchId p) { return p.index; });
}

void writeIds(ByteWriter& writer, const std::vector<uint32_t>& ids) {
    writer.u32(uint32_t(ids.size()));
    for (const uint32_t id : ids) writer.u32(id);
}

// Whether as many items of at least `size` bytes may follow.
bool fits(const ByteReader& reader, uint32_t count, size_t size) {
    return !reader.failed() && count <= reader.left() / size;
}

// Ids that ascend, below `limit`. False where they are not.
bool readIds(ByteReader& reader, size_t limit, std::vector<uint32_t>& ids) {
    const uint32_t count = reader.u32();
    if (!fits(reader, count, 4)) return false;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t id = reader.u32();
        if (id >= limit || (!ids.empty() && id <= ids.back())) return false;
        ids.push_back(id);
    }
    return true;
}

void writePoint(ByteWriter& writer, LatticePoint p) {
    writer.u32(uint32_t(p.x));
    writer.u32(uint32_t(p.y));
}

LatticePoint readPoint(ByteReader& reader) {
    const auto x = int32_t(reader.u32()), y = int32_t(reader.u32());
    return {x, y};
}

bool inRange(LatticePoint p) {
    return std::abs(int64_t(p.x)) < kMaxCoordinate && std::abs(int64_t(p.y)) < kMaxCoordinate;
}

void writeFloat(ByteWriter& writer, float value) {
    writer.u32(std::bit_cast<uint32_t>(value));
}

float readFloat(ByteReader& reader) {
    return std::bit_cast<float>(reader.u32());
}

void writeSpline(ByteWriter& writer, const PatchSpline& spline) {
    writer.raw(spline.terms);
    writer.u8(uint8_t(spline.sites.size()));
    writer.raw(spline.sites);
    writer.u8(uint8_t(spline.centres.size()));
    for (const glm::vec2 centre : spline.centres) {
        writeFloat(writer, centre.x);
        writeFloat(writer, centre.y);
    }
    for (const float k : spline.coefficients) writeFloat(writer, k);
}

std::string readSpline(ByteReader& reader, int channels, const SiteLattice& lattice, PatchSpline& spline) {
    for (uint8_t& terms : spline.terms) terms = reader.u8();
    spline.sites = reader.raw(reader.u8());
    const int centres = reader.u8();
    for (int i = 0; i < centres && !reader.failed(); ++i) {
        const float x = readFloat(reader), y = readFloat(reader);
        spline.centres.push_back({x, y});
    }
    for (size_t i = spline.offset(channels); i > 0 && !reader.failed(); --i)
        spline.coefficients.push_back(readFloat(reader));
    if (reader.failed()) return kCutShort;
    const std::string wrong = lattice.adopt(spline);
    return wrong.empty() ? splineViolation(spline, channels) : wrong;
}

// Whether a point of the border stays on its side of the picture, and a corner where it is.
bool keepsBorder(const PatchMesh& mesh, LatticePoint now, LatticePoint then) {
    const int32_t right = mesh.width() * kLatticePerPixel, bottom = mesh.height() * kLatticePerPixel;
    return (now.x != 0 && now.x != right ? then.x >= 0 && then.x <= right : then.x == now.x) &&
           (now.y != 0 && now.y != bottom ? then.y >= 0 && then.y <= bottom : then.y == now.y);
}

}  // namespace

FileNumbers::FileNumbers(const HalfedgeMesh& mesh, FileOrder order)
    : vertices(std::move(order.vertices)), patches(std::move(order.faces)) {
    std::vector<bool> seen(mesh.edgeCapacity(), false);
    for (const PatchId p : patches)
        for (const HalfedgeId side : mesh.sides(p)) {
            const uint32_t e = HalfedgeMesh::edge(side).index;
            if (!seen[e]) edges.push_back(side);
            seen[e] = true;
        }
}

namespace {

FileOrder orderOf(const HalfedgeMesh& decoded) {
    FileOrder order;
    for (uint32_t v = 0; v < decoded.vertexCapacity(); ++v) order.vertices.push_back(VertexId(v));
    for (uint32_t p = 0; p < decoded.faceCapacity(); ++p) order.faces.push_back(PatchId(p));
    return order;
}

}  // namespace

FileNumbers::FileNumbers(const HalfedgeMesh& decoded) : FileNumbers(decoded, orderOf(decoded)) {}

std::vector<uint8_t> encodePatchAttributes(const PatchMesh& mesh, const FileNumbers& numbers) {
    std::vector<std::pair<uint32_t, uint8_t>> set;
    for (uint32_t i = 0; i < numbers.patches.size(); ++i) {
        const PatchAttributes& a = mesh.attributes(numbers.patches[i]);
        const auto bits =
            uint8_t((a.hidden ? Hidden : 0) | (a.locked ? Locked : 0) | (a.cutOut ? CutOut : 0));
        if (bits != 0) set.emplace_back(i, bits);
    }
    if (set.empty()) return {};
    ByteWriter writer;
    writer.u32(uint32_t(set.size()));
    for (const auto& [p, bits] : set) {
        writer.u32(p);
        writer.u8(bits);
    }
    return writer.take();
}

std::string decodePatchAttributes(std::span<const uint8_t> bytes, PatchMesh& mesh) {
    ByteReader reader(bytes);
    const uint32_t count = reader.u32();
    if (!fits(reader, count, 5)) return kCutShort;
    int64_t last = -1;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t p = reader.u32();
        const uint8_t bits = reader.u8();
        if (p >= mesh.patchCount() || int64_t(p) <= last || bits == 0 || bits > (Hidden | Locked | CutOut))
            return kWrongId;
        mesh.setAttributes(PatchId(p), {(bits & Hidden) != 0, (bits & Locked) != 0, (bits & CutOut) != 0});
        last = p;
    }
    return {};
}

std::vector<uint8_t> encodeColourBreaks(const PatchMesh& mesh, const FileNumbers& numbers) {
    std::vector<uint32_t> breaks;
    for (uint32_t e = 0; e < numbers.edges.size(); ++e)
        if (mesh.curve(HalfedgeMesh::edge(numbers.edges[e])).colourBreak) breaks.push_back(e);
    if (breaks.empty()) return {};
    ByteWriter writer;
    writeIds(writer, breaks);
    return writer.take();
}

std::string decodeColourBreaks(std::span<const uint8_t> bytes, PatchMesh& mesh) {
    const FileNumbers numbers(mesh.connectivity());
    ByteReader reader(bytes);
    std::vector<uint32_t> breaks;
    if (!readIds(reader, numbers.edges.size(), breaks)) return kWrongId;
    for (const uint32_t id : breaks) {
        const EdgeId e = HalfedgeMesh::edge(numbers.edges[id]);
        EdgeCurve curve = mesh.curve(e);
        if (curve.feature || mesh.connectivity().onBorder(e))
            return "has a colour break on a feature or border";
        curve.colourBreak = true;
        mesh.setCurve(e, curve);
    }
    return {};
}

std::vector<uint8_t> encodeSelections(const std::vector<NamedSelection>& selections,
                                      const FileNumbers& numbers) {
    if (selections.empty()) return {};
    size_t capacity = 0;
    for (const PatchId p : numbers.patches) capacity = std::max<size_t>(capacity, p.index + size_t{1});
    const auto number = patchNumbers(numbers, capacity);
    ByteWriter writer;
    writer.u32(uint32_t(selections.size()));
    for (const NamedSelection& selection : selections) {
        std::vector<uint32_t> ids;
        for (const PatchId p : selection.patches)
            if (p.index < capacity && number[p.index] != FileMesh::kNone) ids.push_back(number[p.index]);
        std::sort(ids.begin(), ids.end());
        writer.string(selection.name);
        writeIds(writer, ids);
    }
    return writer.take();
}

std::string decodeSelections(std::span<const uint8_t> bytes, const PatchMesh& mesh,
                             std::vector<NamedSelection>& selections) {
    ByteReader reader(bytes);
    const uint32_t count = reader.u32();
    if (!fits(reader, count, 8)) return kCutShort;
    for (uint32_t i = 0; i < count; ++i) {
        NamedSelection& selection = selections.emplace_back();
        selection.name = reader.string();
        std::vector<uint32_t> ids;
        if (!readIds(reader, mesh.patchCount(), ids)) return kWrongId;
        for (const uint32_t id : ids) selection.patches.push_back(PatchId(id));
    }
    return {};
}

namespace {

// What of a mesh has a counterpart in the fitted one and differs from it, by the file's ids.
struct FittedDifferences {
    std::vector<uint32_t> gone, vertices, edges, interiors, splines;
    bool joins = false;

    bool empty() const {
        return gone.empty() && vertices.empty() && edges.empty() && interiors.empty() && splines.empty() &&
               !joins;
    }
};

FittedDifferences findDifferences(const PatchMesh& mesh, const PatchMesh& fitted,
                                  const FileNumbers& numbers) {
    const HalfedgeMesh& c = mesh.connectivity();
    FittedDifferences found;
    std::vector<bool> vertexKnown(c.vertexCapacity(), false), edgeKnown(c.edgeCapacity(), false);
    for (uint32_t i = 0; i < numbers.patches.size(); ++i) {
        const PatchId p = numbers.patches[i];
        if (!hasFitted(mesh, fitted, p)) {
            found.gone.push_back(i);
            continue;
        }
        for (const HalfedgeId side : c.sides(p)) {
            vertexKnown[c.origin(side).index] = true;
            edgeKnown[HalfedgeMesh::edge(side).index] = true;
        }
        if (mesh.interior(p) != fitted.interior(p)) found.interiors.push_back(i);
        if (mesh.spline(p) != fitted.spline(p)) found.splines.push_back(i);
    }
    for (uint32_t i = 0; i < numbers.vertices.size(); ++i) {
        const VertexId v = numbers.vertices[i];
        if (vertexKnown[v.index] && mesh.position(v) != fitted.position(v)) found.vertices.push_back(i);
    }
    for (uint32_t i = 0; i < numbers.edges.size(); ++i) {
        const EdgeId e = HalfedgeMesh::edge(numbers.edges[i]);
        const EdgeCurve &now = mesh.curve(e), &then = fitted.curve(e);
        if (edgeKnown[e.index] && (now.c1 != then.c1 || now.c2 != then.c2)) found.edges.push_back(i);
    }
    return found;
}

// The fitted mesh's joins in the file's ids, as far as the mesh still has their elements; ascending.
std::vector<SmoothJoin> fittedJoins(const PatchMesh& mesh, const std::vector<SmoothJoin>& joins,
                                    const FileNumbers& numbers) {
    const HalfedgeMesh& c = mesh.connectivity();
    const auto vertex = inverse(numbers.vertices, c.vertexCapacity(), [](VertexId v) { return v.index; });
    const auto edge =
        inverse(numbers.edges, c.edgeCapacity(), [](HalfedgeId h) { return HalfedgeMesh::edge(h).index; });
    std::vector<SmoothJoin> result;
    for (const SmoothJoin& join : joins) {
        if (join.vertex.index >= vertex.size() || join.first.index >= edge.size() ||
            join.second.index >= edge.size())
            continue;
        const uint32_t v = vertex[join.vertex.index], e = edge[join.first.index], f = edge[join.second.index];
        if (v == FileMesh::kNone || e == FileMesh::kNone || f == FileMesh::kNone) continue;
        result.push_back({VertexId(v), EdgeId(std::min(e, f)), EdgeId(std::max(e, f))});
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

}  // namespace

std::vector<uint8_t> encodeFitted(const PatchMesh& mesh, const PatchMesh& fitted,
                                  const FileNumbers& numbers) {
    FittedDifferences found = findDifferences(mesh, fitted, numbers);
    const std::vector<SmoothJoin> joins = fittedJoins(mesh, fitted.smoothJoins(), numbers);
    found.joins = joins != fittedJoins(mesh, mesh.smoothJoins(), numbers);
    if (found.empty()) return {};
    ByteWriter writer;
    writeIds(writer, found.gone);
    writeIds(writer, found.vertices);
    for (const uint32_t i : found.vertices) writePoint(writer, fitted.position(numbers.vertices[i]));
    writeIds(writer, found.edges);
    for (const uint32_t i : found.edges) {
        const auto points = fitted.controlPoints(numbers.edges[i]);
        writePoint(writer, points[1]);
        writePoint(writer, points[2]);
    }
    writeIds(writer, found.interiors);
    for (const uint32_t i : found.interiors) writePoint(writer, fitted.interior(numbers.patches[i]));
    writeIds(writer, found.splines);
    for (const uint32_t i : found.splines) writeSpline(writer, fitted.spline(numbers.patches[i]));
    writer.u8(found.joins ? 1 : 0);
    if (found.joins) {
        writer.u32(uint32_t(joins.size()));
        for (const SmoothJoin& join : joins) {
            writer.u32(join.vertex.index);
            writer.u32(join.first.index);
            writer.u32(join.second.index);
        }
    }
    return writer.take();
}

namespace {

class FittedReader {
  public:
    FittedReader(std::span<const uint8_t> bytes, const PatchMesh& mesh, const SiteLattice& lattice)
        : mReader(bytes), mNow(mesh), mLattice(lattice), mNumbers(mesh.connectivity()), mFitted(mesh) {}

    std::string run() {
        for (const auto read :
             {&FittedReader::readGone, &FittedReader::readVertices, &FittedReader::readEdges,
              &FittedReader::readInteriors, &FittedReader::readSplines, &FittedReader::readJoins})
            if (std::string wrong = (this->*read)(); !wrong.empty()) return wrong;
        return mReader.failed() ? kCutShort : "";
    }
    PatchMesh take() { return std::move(mFitted); }

  private:
    std::string readGone() {
        std::vector<uint32_t> ids;
        if (!readIds(mReader, mNow.patchCount(), ids)) return kWrongId;
        for (const uint32_t p : ids) mFitted.setSpline(PatchId(p), {});
        return {};
    }
    std::string readVertices() {
        std::vector<uint32_t> ids;
        if (!readIds(mReader, mNumbers.vertices.size(), ids)) return kWrongId;
        for (const uint32_t i : ids) {
            const LatticePoint to = readPoint(mReader);
            if (!keepsBorder(mNow, mNow.position(VertexId(i)), to)) return "has a vertex outside the picture";
            mFitted.setPosition(VertexId(i), to);
        }
        return {};
    }
    std::string readEdges() {
        std::vector<uint32_t> ids;
        if (!readIds(mReader, mNumbers.edges.size(), ids)) return kWrongId;
        for (const uint32_t i : ids) {
            const HalfedgeId h = mNumbers.edges[i];
            const LatticePoint c1 = readPoint(mReader), c2 = readPoint(mReader);
            const auto now = mNow.controlPoints(h);
            const bool border = mNow.connectivity().onBorder(HalfedgeMesh::edge(h));
            if (!inRange(c1) || !inRange(c2) ||
                (border && !(keepsBorder(mNow, now[1], c1) && keepsBorder(mNow, now[2], c2))))
                return "has a curve that cannot be";
            mFitted.setInnerControlPoints(h, c1, c2);
        }
        return {};
    }
    std::string readInteriors() {
        std::vector<uint32_t> ids;
        if (!readIds(mReader, mNow.patchCount(), ids)) return kWrongId;
        for (const uint32_t p : ids) {
            const LatticePoint to = readPoint(mReader);
            if (!inRange(to)) return "has an interior point that cannot be";
            mFitted.setInterior(PatchId(p), to);
        }
        return {};
    }
    std::string readSplines() {
        std::vector<uint32_t> ids;
        if (!readIds(mReader, mNow.patchCount(), ids)) return kWrongId;
        for (const uint32_t p : ids) {
            PatchSpline spline;
            if (std::string wrong = readSpline(mReader, mNow.channels(), mLattice, spline); !wrong.empty())
                return wrong;
            mFitted.setSpline(PatchId(p), std::move(spline));
        }
        return {};
    }
    std::string readJoins() {
        const uint8_t differ = mReader.u8();
        if (differ == 0) return {};
        const uint32_t count = mReader.u32();
        if (differ > 1 || !fits(mReader, count, 12)) return kCutShort;
        std::vector<SmoothJoin> joins;
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t v = mReader.u32(), e = mReader.u32(), f = mReader.u32();
            if (v >= mNumbers.vertices.size() || e >= mNumbers.edges.size() || f >= mNumbers.edges.size())
                return kWrongId;
            joins.push_back(
                {VertexId(v), HalfedgeMesh::edge(mNumbers.edges[e]), HalfedgeMesh::edge(mNumbers.edges[f])});
        }
        mFitted.setSmoothJoins(std::move(joins));
        return {};
    }

    ByteReader mReader;
    const PatchMesh& mNow;
    const SiteLattice& mLattice;
    FileNumbers mNumbers;
    PatchMesh mFitted;
};

}  // namespace

std::string decodeFitted(std::span<const uint8_t> bytes, uint32_t version, const PatchMesh& mesh,
                         std::optional<PatchMesh>& fitted) {
    FittedReader reader(bytes, mesh, SiteLattice::ofVersion(version));
    std::string wrong = reader.run();
    if (wrong.empty()) fitted = reader.take();
    return wrong;
}

}  // namespace tessera
