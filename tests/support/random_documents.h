// Documents for codec tests: random meshes with everything set that a document can hold.
#pragma once

#include <algorithm>
#include <numeric>
#include <random>

#include "core/document/document.h"
#include "core/mesh/newton_basis.h"
#include "tests/support/test_meshes.h"

namespace tessera::testing {

inline std::vector<uint8_t> randomBytes(size_t count, std::mt19937& random) {
    std::vector<uint8_t> bytes(count);
    for (uint8_t& b : bytes) b = uint8_t(random());
    return bytes;
}

// Collapses up to `count` inner edges wherever connectivity lets it. Geometry is not kept certified: the
// codec does not ask for that.
inline void collapseSome(PatchMesh& mesh, int count, std::mt19937& random, HalfedgeMesh& connectivity) {
    for (int tries = 0; count > 0 && tries < 20 * count; ++tries) {
        const HalfedgeId h(uint32_t(random() % (2 * connectivity.edgeCapacity())));
        if (!connectivity.alive(HalfedgeMesh::edge(h))) continue;
        if (connectivity.onBorder(connectivity.origin(h)) || !connectivity.canCollapse(h)) continue;
        const bool free = !connectivity.onBorder(connectivity.target(h));
        connectivity.collapse(h, {free && random() % 2 == 0, free && random() % 2 == 0});
        --count;
    }
    // The model has no way to take another connectivity: build a mesh over it and copy what is per element.
    std::vector<LatticePoint> positions(connectivity.vertexCapacity());
    for (uint32_t v = 0; v < positions.size(); ++v) positions[v] = mesh.position(VertexId(v));
    PatchMesh collapsed(mesh.width(), mesh.height(), mesh.channels(), connectivity, positions);
    collapsed.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        const EdgeCurve straight = collapsed.curve(e);
        if (connectivity.onBorder(e)) {
            curve.c1 = straight.c1;
            curve.c2 = straight.c2;
        }
        collapsed.setCurve(e, curve);
    });
    collapsed.forEachPatch([&](PatchId p) {
        collapsed.setSpline(p, mesh.spline(p));
        collapsed.setInterior(p, mesh.interior(p));
    });
    mesh = collapsed;
}

// curvedMesh with blurs, smooth joins, splines of few terms, of centres of their own and of large values,
// and, where `collapses` is above 0, deleted elements.
inline PatchMesh richMesh(unsigned seed, int channels, int collapses, int columns = 9, int rows = 7) {
    std::mt19937 random(seed);
    PatchMesh mesh = curvedMesh(211, 150, columns, rows, seed, channels);
    if (collapses > 0) {
        HalfedgeMesh connectivity = mesh.connectivity();
        collapseSome(mesh, collapses, random, connectivity);
    }
    const HalfedgeMesh& c = mesh.connectivity();
    std::uniform_real_distribution<float> unit(0, 1);
    mesh.forEachEdge([&](EdgeId e) {
        EdgeCurve curve = mesh.curve(e);
        if (curve.feature && random() % 2 == 0) curve.blurSigma = {3 * unit(random), 40 * unit(random)};
        mesh.setCurve(e, curve);
    });
    std::vector<SmoothJoin> joins;
    mesh.forEachVertex([&](VertexId v) {
        if (random() % 3 != 0) return;
        const HalfedgeId h = c.halfedge(v);
        joins.push_back({v, HalfedgeMesh::edge(c.rotate(h)), HalfedgeMesh::edge(h)});
    });
    mesh.setSmoothJoins(joins);
    mesh.forEachPatch([&](PatchId p) {
        PatchSpline spline;
        const unsigned kind = unsigned(random() % 12);
        if (kind > 4) return;
        for (int ch = 0; ch < channels; ++ch) {
            const int terms = kind == 0 ? 0 : kind == 1 ? 3 + int(random() % 14) : kind == 2 ? 3 : 0;
            spline.terms[size_t(ch)] = uint8_t(terms);
            const int n = std::max(3, terms);
            const NodalBasis basis = nodalBasis(std::span(defaultCentres()).first(size_t(n)));
            std::vector<double> values;
            const double size = kind == 3 ? 1e4 : 1;
            for (int i = 0; i < n; ++i) values.push_back(size * double(unit(random)));
            for (int r = 0; r < 3 + terms; ++r) {
                double sum = 0;
                for (int i = 0; i < n; ++i)
                    sum += basis.toCoefficients[size_t(r * n + i)] * values[size_t(i)];
                spline.coefficients.push_back(float(sum));
            }
        }
        if (kind == 4) {
            spline = {};
            for (int i = 0; i < 5; ++i) spline.centres.push_back({unit(random), unit(random)});
            for (int ch = 0; ch < channels; ++ch) {
                spline.terms[size_t(ch)] = uint8_t(3 + random() % 3);
                for (int r = 0; r < 3 + spline.terms[size_t(ch)]; ++r)
                    spline.coefficients.push_back(unit(random));
            }
        }
        mesh.setSpline(p, spline);
    });
    return mesh;
}

// The same mesh with splines on sites in the opponent basis, and among them some of the others: rough ones
// and smooth ones, each channel of as many terms as chance will have, in the order that chance gives them;
// values that factors cannot hold; lists that do not begin with the corners; alphas that break the side
// conditions.
inline PatchMesh siteMesh(unsigned seed, int channels, int collapses = 0, int columns = 9, int rows = 7) {
    std::mt19937 random(seed);
    PatchMesh mesh = richMesh(seed, channels, collapses, columns, rows);
    mesh.setColourBasis(ColourBasis::Opponent);
    std::uniform_real_distribution<double> unit(0, 1);
    mesh.forEachPatch([&](PatchId p) {
        const unsigned kind = unsigned(random() % 16);
        if (kind == 0) return;
        std::vector<uint8_t> sites(kCentreSites);
        std::iota(sites.begin(), sites.end(), uint8_t{0});
        std::shuffle(sites.begin() + 3, sites.end(), random);
        sites.resize(kind == 1 ? size_t(kCentreSites) : kind == 2 ? 3 : 3 + random() % 30);
        const double size = kind == 3 ? 1e9 : kind == 4 ? 1e-4 : .1;
        std::array<std::vector<double>, kMaxChannels> factors;
        std::array<std::span<const double>, kMaxChannels> spans;
        for (size_t c = 0; c < size_t(channels); ++c) {
            factors[c].resize(c == 0 ? sites.size() : 3 + random() % (sites.size() - 2));
            for (size_t k = 0; k < factors[c].size(); ++k)
                factors[c][k] = k < 3 ? unit(random) : size * (unit(random) - .5);
            spans[c] = factors[c];
        }
        PatchSpline spline = NewtonBasis(sites).spline({spans.data(), size_t(channels)});
        if (kind == 5) {
            std::vector<uint8_t> turned(spline.sites.begin(), spline.sites.end());
            std::rotate(turned.begin(), turned.begin() + 1, turned.end());
            spline.sites = turned;
        }
        if (kind == 6) spline.coefficients.back() += 1;
        mesh.setSpline(p, spline);
    });
    return mesh;
}

inline Document richDocument(unsigned seed, int channels = 3, int collapses = 0, bool sites = false) {
    std::mt19937 random(seed);
    Document d;
    d.mesh = sites ? siteMesh(seed, channels, collapses) : richMesh(seed, channels, collapses);
    d.settings.patches = 126;
    d.settings.stageVariants["curves"] = "straight";
    d.report.stages = {{"features", "canny", 1.0 / 3, {{"chains", 12}, {"edge pixels", 3456}}},
                       {"colours", "x", 0, {}}};
    d.report.shortfall = "It got stuck.";
    d.difference = ImageDifference{1.5, {1, 2, 3}, 4, 5, 31.25, 7, 8, .875};
    d.source = {"photo.png", 123456, std::string(64, 'a'), "png", 211, 150, 8, randomBytes(300, random)};
    d.embeddedSource = std::make_shared<const std::vector<uint8_t>>(randomBytes(1000, random));
    d.previewPng = std::make_shared<const std::vector<uint8_t>>(200, uint8_t{7});
    d.unknownChunks = {{{'n', 'e', 'w', '1'}, true, {1, 2, 3}}, {{'n', 'e', 'w', '2'}, false, {}}};
    return d;
}

}  // namespace tessera::testing
