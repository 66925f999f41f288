// See mesh_codec.h.
#include "core/document/mesh_codec.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/document/byte_stream.h"
#include "core/document/colour_codec.h"
#include "core/document/factor_codec.h"
#include "core/document/file_mesh.h"
#include "core/document/geometry_codec.h"
#include "core/document/range_coder.h"

namespace tessera {

namespace {

constexpr uint32_t kMaxFaces = 1u << 26;
constexpr size_t kGrain = 64;
// What storing may take from the PSNR of a document that knows its own, and what is assumed of others.
constexpr double kPsnrLoss = .09, kAssumedPsnr = 45, kLargestPsnr = 60;
// What rounding moves the fitted channels by at most, root mean square, however large the picture's error is:
// seams show it twice, and bear no more where pictures are hard. Measured.
constexpr double kLargestRounding = .7 / 255;

tl::unexpected<Error> broken(const std::string& what) {
    return failure(ErrorCode::Internal, "the mesh cannot be stored: it " + what + "; please report this");
}

// The file's view of a mesh's triangles, from the order that the encoder has chosen.
FileMesh fileMesh(const HalfedgeMesh& mesh, const FileOrder& order, std::vector<uint32_t>& fileVertex) {
    FileMesh file;
    file.vertexCount = uint32_t(order.vertices.size());
    fileVertex.assign(mesh.vertexCapacity(), FileMesh::kNone);
    for (uint32_t i = 0; i < order.vertices.size(); ++i) fileVertex[order.vertices[i].index] = i;
    for (const FaceId f : order.faces) {
        const auto corners = mesh.corners(f);
        file.triangles.push_back(
            {fileVertex[corners[0].index], fileVertex[corners[1].index], fileVertex[corners[2].index]});
    }
    return file;
}

// The halfedge of each edge of the file, in the file's direction. `faces` by the file's ids.
std::vector<HalfedgeId> edgeHalfedges(const FileMesh& file, const HalfedgeMesh& mesh,
                                      const std::vector<FaceId>& faces) {
    std::vector<HalfedgeId> halfedges;
    halfedges.reserve(file.edges.size());
    for (const FileMesh::Edge& e : file.edges) halfedges.push_back(mesh.sides(faces[e.face])[e.side]);
    return halfedges;
}

bool runsAlong(HalfedgeId h) {
    return HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) == h;
}

std::string gatherEdges(const PatchMesh& mesh, const std::vector<HalfedgeId>& halfedges, FileGeometry& g) {
    for (const HalfedgeId h : halfedges) {
        const auto points = mesh.controlPoints(h);
        g.inner.push_back({points[1], points[2]});
        const EdgeCurve& curve = mesh.curve(HalfedgeMesh::edge(h));
        FileGeometry::Attributes a;
        a.feature = curve.feature;
        for (size_t i = 0; i < 2; ++i) {
            const float sigma = curve.blurSigma[runsAlong(h) ? i : 1 - i];
            if (!(sigma >= 0 && double(sigma) * kBlurStepsPerPixel <= double(kMaxBlurSteps)))
                return "has a blur that is not a number from 0 to 65536";
            a.blur[i] = std::llround(double(sigma) * kBlurStepsPerPixel);
        }
        g.attributes.push_back(a);
    }
    return {};
}

std::string gatherJoins(const PatchMesh& mesh, const FileMesh& file, const std::vector<HalfedgeId>& halfedges,
                        const std::vector<uint32_t>& fileVertex, FileGeometry& g) {
    std::vector<uint32_t> fileEdge(mesh.connectivity().edgeCapacity(), FileMesh::kNone);
    for (uint32_t e = 0; e < halfedges.size(); ++e) fileEdge[HalfedgeMesh::edge(halfedges[e]).index] = e;
    const auto at = [](const auto& ids, uint32_t index) {
        return index < ids.size() ? ids[index] : FileMesh::kNone;
    };
    for (const SmoothJoin& join : mesh.smoothJoins()) {
        const uint32_t v = at(fileVertex, join.vertex.index), e = at(fileEdge, join.first.index),
                       f = at(fileEdge, join.second.index);
        const auto meets = [&](uint32_t edge) {
            return edge != FileMesh::kNone && (file.edges[edge].from == v || file.edges[edge].to == v);
        };
        if (v == FileMesh::kNone || e == f || !meets(e) || !meets(f))
            return "has a smooth join of curves that do not meet";
        g.joins.push_back({v, std::min(e, f), std::max(e, f)});
    }
    std::sort(g.joins.begin(), g.joins.end());
    g.joins.erase(std::unique(g.joins.begin(), g.joins.end()), g.joins.end());
    return {};
}

std::vector<bool> featuresOf(const FileGeometry& g) {
    std::vector<bool> features;
    features.reserve(g.attributes.size());
    for (const auto& a : g.attributes) features.push_back(a.feature);
    return features;
}

// A mesh from what was decoded, all of it known to be sound.
PatchMesh assemble(const FileMesh& file, const FileGeometry& g, int channels,
                   std::vector<PatchSpline> splines) {
    PatchMesh mesh(g.width, g.height, channels, HalfedgeMesh::fromTriangles(file.vertexCount, file.triangles),
                   g.positions);
    std::vector<FaceId> faces;
    for (uint32_t f = 0; f < file.triangles.size(); ++f) faces.push_back(FaceId(f));
    const auto halfedges = edgeHalfedges(file, mesh.connectivity(), faces);
    for (uint32_t e = 0; e < halfedges.size(); ++e) {
        const HalfedgeId h = halfedges[e];
        const size_t first = runsAlong(h) ? 0 : 1;
        EdgeCurve curve;
        curve.c1 = g.inner[e][first];
        curve.c2 = g.inner[e][1 - first];
        curve.feature = g.attributes[e].feature;
        for (size_t i = 0; i < 2; ++i)
            curve.blurSigma[i] =
                float(g.attributes[e].blur[i == 0 ? first : 1 - first]) / float(kBlurStepsPerPixel);
        mesh.setCurve(HalfedgeMesh::edge(h), curve);
    }
    for (const FaceId f : faces) {
        mesh.setInterior(f, g.interior[f.index]);
        mesh.setSpline(f, std::move(splines[f.index]));
    }
    std::vector<SmoothJoin> joins;
    for (const auto& j : g.joins)
        joins.push_back({VertexId(j.vertex), HalfedgeMesh::edge(halfedges[j.first]),
                         HalfedgeMesh::edge(halfedges[j.second])});
    mesh.setSmoothJoins(std::move(joins));
    return mesh;
}

// How the colours of a document are stored from version 2 on.
enum ColourMethod : uint8_t { Values = 0, Factors = 1 };

bool usesSites(const PatchMesh& mesh) {
    bool uses = false;
    mesh.forEachPatch([&](PatchId p) { uses = uses || !mesh.spline(p).sites.empty(); });
    return uses;
}

tl::expected<std::vector<uint8_t>, std::string> encodeColourChunk(const PatchMesh& mesh,
                                                                  const FileOrder& order,
                                                                  const FileMesh& file, const FileGeometry& g,
                                                                  double step) {
    const int channels = mesh.channels();
    for (const FaceId f : order.faces)
        if (const auto wrong = splineViolation(mesh.spline(f), channels); !wrong.empty())
            return tl::unexpected<std::string>("has a patch whose colour " + wrong);
    const bool factors = usesSites(mesh);
    RangeEncoder coder;
    std::string wrong;
    size_t least = 0;
    const auto forEach = [&](auto&& visit) {
        parallelFor(order.faces.size(), kGrain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) visit(i, mesh.spline(order.faces[i]));
        });
    };
    if (factors) {
        const std::vector<double> areas = relativeAreas(file, g);
        const std::vector<bool> features = featuresOf(g);
        std::vector<FactorColour> colours(order.faces.size());
        forEach([&](size_t i, const PatchSpline& spline) {
            colours[i] = quantizedFactors(spline, channels, step, areas[i]);
        });
        wrong = encodeFactors(coder, {file, features, areas, channels, step}, colours);
        least = leastFactorBytes(colours, channels);
    } else {
        std::vector<FileColour> colours(order.faces.size());
        forEach([&](size_t i, const PatchSpline& spline) { colours[i] = quantized(spline, channels, step); });
        wrong = encodeColours(coder, file, featuresOf(g), channels, colours);
    }
    if (!wrong.empty()) return tl::unexpected<std::string>(wrong);
    ByteWriter writer;
    writer.f64(step);
    writer.u8(uint8_t(mesh.colourBasis()));
    writer.u8(factors ? Factors : Values);
    std::vector<uint8_t> stream = coder.finish();
    // A byte for each patch, so that a reader can bound what it takes.
    stream.resize(std::max({stream.size(), least, order.faces.size()}));
    writer.raw(stream);
    return writer.take();
}

struct DecodedColours {
    double step = 0;
    ColourBasis basis = ColourBasis::Rgb;
    std::vector<PatchSpline> splines;
};

tl::expected<DecodedColours, std::string> decodeColourChunk(std::span<const uint8_t> bytes, uint32_t version,
                                                            const FileMesh& file, const FileGeometry& g,
                                                            int channels) {
    ByteReader head(bytes);
    DecodedColours colours;
    colours.step = head.f64();
    if (!(colours.step >= 1e-9 && colours.step <= 1))
        return tl::unexpected<std::string>("has a colour step that cannot be");
    uint8_t method = Values;
    if (version > 1) {
        const uint8_t basis = head.u8();
        if (basis > uint8_t(ColourBasis::Opponent))
            return tl::unexpected<std::string>("has a basis that cannot be");
        colours.basis = ColourBasis(basis);
        method = head.u8();
        if (method > Factors) return tl::unexpected<std::string>("has colours of a kind that cannot be");
    }
    const auto stream = head.raw(head.left());
    RangeDecoder coder(stream);
    std::string wrong;
    if (method == Factors) {
        const std::vector<double> areas = relativeAreas(file, g);
        const std::vector<bool> features = featuresOf(g);
        const SiteLattice& lattice = SiteLattice::ofVersion(version);
        wrong = decodeFactors(coder, {file, features, areas, channels, colours.step, version}, stream.size(),
                              colours.splines);
        for (size_t i = 0; i < colours.splines.size() && wrong.empty(); ++i)
            wrong = lattice.adopt(colours.splines[i]);
    } else {
        std::vector<FileColour> values;
        wrong = decodeColours(coder, file, featuresOf(g), channels, values);
        colours.splines.resize(values.size());
        if (wrong.empty())
            parallelFor(values.size(), kGrain, [&](size_t begin, size_t end) {
                for (size_t i = begin; i < end; ++i)
                    colours.splines[i] = dequantized(values[i], channels, colours.step);
            });
    }
    for (size_t i = 0; i < colours.splines.size() && wrong.empty(); ++i)
        wrong = splineViolation(colours.splines[i], channels);
    if (!wrong.empty()) return tl::unexpected<std::string>(wrong);
    return colours;
}

bool sizesGood(int64_t width, int64_t height, int channels) {
    return width >= 1 && height >= 1 && width <= kMaxPictureSide && height <= kMaxPictureSide &&
           (channels == 3 || channels == 4);
}

}  // namespace

double chooseColourStep(const PatchMesh& mesh, std::optional<double> psnr) {
    if (!usesSites(mesh)) return defaultColourStep();
    // kPsnrLoss dB are this share of the error that the picture has already.
    const double share = std::pow(10, kPsnrLoss / 10) - 1;
    // fmin, since a PSNR may be anything that a file had.
    const double known = std::fmin(psnr.value_or(kAssumedPsnr), kLargestPsnr);
    const double added = std::min(share * std::pow(10, -known / 10), kLargestRounding * kLargestRounding);
    double factors = 0;
    mesh.forEachPatch([&](PatchId p) {
        for (int c = 0; c < mesh.channels(); ++c)
            factors += std::max<int>(3, mesh.spline(p).terms[size_t(c)]);
    });
    return factorStep(added * mesh.channels(), factors / double(mesh.patchCount()));
}

Result<MeshChunks> encodeMesh(const PatchMesh& mesh, double colourStep) {
    const int channels = mesh.channels();
    const HalfedgeMesh& connectivity = mesh.connectivity();
    if (!sizesGood(mesh.width(), mesh.height(), channels))
        return broken("has a size that the format does not hold");
    if (connectivity.faceCount() == 0 || connectivity.faceCount() > kMaxFaces)
        return broken("has no patches, or more than the format holds");

    RangeEncoder connectivityCoder;
    const FileOrder order = encodeConnectivity(connectivityCoder, connectivity);
    if (order.faces.empty()) return broken("is not connected");
    std::vector<uint32_t> fileVertex;
    FileMesh file = fileMesh(connectivity, order, fileVertex);
    if (const auto wrong = deriveFileMesh(file); !wrong.empty()) return broken(wrong);
    const auto halfedges = edgeHalfedges(file, connectivity, order.faces);

    FileGeometry g;
    g.width = mesh.width();
    g.height = mesh.height();
    for (const VertexId v : order.vertices) g.positions.push_back(mesh.position(v));
    for (const FaceId f : order.faces) g.interior.push_back(mesh.interior(f));
    if (const auto wrong = gatherEdges(mesh, halfedges, g); !wrong.empty()) return broken(wrong);
    if (const auto wrong = gatherJoins(mesh, file, halfedges, fileVertex, g); !wrong.empty())
        return broken(wrong);
    RangeEncoder geometryCoder, curveCoder;
    if (const auto wrong = encodeGeometry(geometryCoder, file, g); !wrong.empty()) return broken(wrong);
    if (const auto wrong = borderViolation(file, g); !wrong.empty()) return broken(wrong);
    if (const auto wrong = encodeAttributes(curveCoder, file, g); !wrong.empty()) return broken(wrong);

    for (const FaceId f : order.faces)
        if (const auto wrong = splineViolation(mesh.spline(f), channels); !wrong.empty())
            return broken("has a patch whose colour " + wrong);
    auto colours = encodeColourChunk(mesh, order, file, g, colourStep);
    if (!colours) return broken(colours.error());

    MeshChunks chunks;
    ByteWriter head;
    head.u32(uint32_t(g.width));
    head.u32(uint32_t(g.height));
    head.u8(uint8_t(channels));
    head.u32(uint32_t(file.triangles.size()));
    head.raw(connectivityCoder.finish());
    chunks.connectivity = head.take();
    chunks.geometry = geometryCoder.finish();
    chunks.curves = curveCoder.finish();
    chunks.colours = std::move(*colours);
    chunks.order = order;
    return chunks;
}

tl::expected<DecodedMesh, MeshDamage> decodeMesh(const MeshChunkBytes& chunks, uint32_t version) {
    const auto damage = [](auto chunk, std::string what) {
        return tl::unexpected<MeshDamage>(MeshDamage{chunk, std::move(what)});
    };
    ByteReader head(chunks.connectivity);
    FileGeometry g;
    const uint32_t width = head.u32(), height = head.u32();
    const int channels = head.u8();
    const uint32_t faceCount = head.u32();
    if (head.failed()) return damage(MeshDamage::Connectivity, "ends within its first numbers");
    if (!sizesGood(width, height, channels))
        return damage(MeshDamage::Connectivity, "has a picture size that cannot be");
    if (faceCount == 0 || faceCount > kMaxFaces || faceCount > chunks.colours.size())
        return damage(MeshDamage::Connectivity, "has a number of patches that cannot be");
    g.width = int(width);
    g.height = int(height);

    FileMesh file;
    RangeDecoder connectivityCoder(head.raw(head.left()));
    if (auto wrong = decodeConnectivity(connectivityCoder, faceCount, file); !wrong.empty())
        return damage(MeshDamage::Connectivity, std::move(wrong));
    if (auto wrong = deriveFileMesh(file); !wrong.empty())
        return damage(MeshDamage::Connectivity, std::move(wrong));

    RangeDecoder geometryCoder(chunks.geometry), curveCoder(chunks.curves);
    if (auto wrong = decodeGeometry(geometryCoder, version, file, g); !wrong.empty())
        return damage(MeshDamage::Geometry, std::move(wrong));
    if (auto wrong = borderViolation(file, g); !wrong.empty())
        return damage(MeshDamage::Geometry, std::move(wrong));
    if (auto wrong = decodeAttributes(curveCoder, file, g); !wrong.empty())
        return damage(MeshDamage::Curves, std::move(wrong));

    auto colours = decodeColourChunk(chunks.colours, version, file, g, channels);
    if (!colours) return damage(MeshDamage::Colours, std::move(colours.error()));
    DecodedMesh decoded;
    decoded.colourStep = colours->step;
    decoded.mesh = assemble(file, g, channels, std::move(colours->splines));
    decoded.mesh.setColourBasis(colours->basis);
    return decoded;
}

}  // namespace tessera
