// See color_equations.h.
#include "core/vectorize/color_equations.h"

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <span>

#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/base/row_products.h"
#include "core/mesh/newton_basis.h"
#include "core/mesh/patch_query.h"
#include "core/vectorize/patch_cells.h"

namespace tessera {

namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Where pixels say little colours are smooth: the thin-plate energy over a patch, in px, counts this much of
// a squared error; and nothing drifts: a squared factor counts this much of a patch's pixels.
constexpr double kBending = 1e-2, kRidge = 1e-6;

// Parts of rows as a patch or a seam finds them, apart by whose factors they are, so that each can go as soon
// as its patch has its rows.
struct Parts {
    struct Chunk {
        uint32_t patch;
        std::vector<uint32_t> ids;  // of rows
        PackedRows rows;            // for each of them
    };
    std::vector<Chunk> chunks;

    void add(uint32_t id, uint32_t patch, std::span<const float> row) {
        auto chunk =
            std::find_if(chunks.begin(), chunks.end(), [&](const Chunk& c) { return c.patch == patch; });
        if (chunk == chunks.end()) chunk = chunks.insert(chunk, {patch, {}, {}});
        chunk->ids.push_back(id);
        chunk->rows.push(row);
    }
    void shrink() {
        for (Chunk& chunk : chunks) {
            chunk.ids.shrink_to_fit();
            chunk.rows.shrink();
        }
    }
};

// What stands in for patches that are held.
const NewtonBasis& noBasis() {
    static constexpr uint8_t kCorners[] = {0, 1, 2};
    static const NewtonBasis kNone(kCorners);
    return kNone;
}

class EquationBuilder {
  public:
    EquationBuilder(const PatchMesh& mesh, const FitPicture& picture, const std::vector<SiteChoice>& choices,
                    int samplesPerSide)
        : mMesh(mesh), mPicture(picture), mChoices(choices), mSide(samplesPerSide), mBlur(mesh) {}

    // First of all. False where progress says stop; there is nothing to go on with then.
    bool addUnknowns(const ProgressPart& progress);
    void addCells(const ProgressPart& progress);
    void addSeams(const SeamWeights& weights, const ProgressPart& progress);
    void finish(const ProgressPart& progress);

    ColorEquations m;

  private:
    bool held(uint32_t p) const { return m.patches[p].count == 0; }
    // How many factors a row has for a patch: its unknowns; of a held one its colours, channel by channel.
    size_t factorCount(uint32_t p) const { return size_t(held(p) ? mMesh.channels() : m.patches[p].count); }
    void evaluateFactors(uint32_t p, const float* x, const float* y, size_t count, float* out) const;
    Rows sumsOverCells(uint32_t p, const PatchCells& cells) const;
    struct Slopes;
    void evaluateSlopes(uint32_t p, Slopes& slopes) const;
    void reach(const Rect& box) {
        mReach.min = glm::min(mReach.min, box.min);
        mReach.max = glm::max(mReach.max, box.max);
    }
    bool inReach(PatchId p) const;
    void addPatch(PatchId p, const PatchCells& cells, Parts& parts);
    // A share of a cell that is another place's colour: a blurred feature's, at the foot of a sample.
    struct Foot {
        uint32_t patch, cell;
        float weight;
        glm::vec2 at;
    };
    std::vector<Foot> findFeet(PatchId p, const PatchCells& cells, std::vector<uint8_t>& shared) const;
    void addFeet(std::vector<Foot> feet, Parts& parts);
    void addSide(HalfedgeId h, const ColorEquations::Seam& seam, double sign, const SeamWeights& weights,
                 Parts& parts);

    void gather(ColorEquations::Patch& patch, const std::vector<Parts::Chunk*>& chunks,
                const std::vector<uint32_t>& number);

    const PatchMesh& mMesh;
    const FitPicture& mPicture;
    const std::vector<SiteChoice>& mChoices;
    int mSide;
    EdgeBlur mBlur;
    Rect mReach{glm::dvec2(HUGE_VAL), glm::dvec2(-HUGE_VAL)};  // of the patches that are not held
    std::vector<NewtonBasis> mBases;                           // by patch id
    std::vector<Parts> mParts;
};

// out[k * count + i] is function k at point i.
void EquationBuilder::evaluateFactors(uint32_t p, const float* x, const float* y, size_t count,
                                      float* out) const {
    if (!held(p)) {
        mBases[p].evaluate(x, y, count, out, count);
        return;
    }
    float* planes[kMaxChannels] = {};
    for (size_t c = 0; c < size_t(mMesh.channels()); ++c) planes[c] = out + c * count;
    evaluateSplines(mMesh.spline(PatchId(p)), mMesh.channels(), x, y, count, planes);
}

// Of each function over each cell's samples.
Rows EquationBuilder::sumsOverCells(uint32_t p, const PatchCells& cells) const {
    const auto functions = Eigen::Index(factorCount(p)), count = Eigen::Index(cells.cells.size());
    Rows sums(functions, count);
    if (!held(p)) {
        mBases[p].evaluateSums(cells.x.data(), cells.y.data(), cells.firstSample, sums.data(), size_t(count));
        return sums;
    }
    Rows values(functions, Eigen::Index(cells.x.size()));
    evaluateFactors(p, cells.x.data(), cells.y.data(), cells.x.size(), values.data());
    for (Eigen::Index k = 0; k < count; ++k) {
        const uint32_t first = cells.firstSample[size_t(k)], end = cells.firstSample[size_t(k) + 1];
        sums.col(k) = values.middleCols(first, end - first).rowwise().sum();
    }
    return sums;
}

// Factors and their derivatives along the domain's axes at points of one side of a patch.
struct EquationBuilder::Slopes {
    static constexpr size_t kStride = 24;
    size_t count = 0;
    std::array<float, kStride> x{}, y{};
    std::vector<double> value, alongX, alongY;  // of factor k at point i: k * kStride + i
};

void EquationBuilder::evaluateSlopes(uint32_t p, Slopes& slopes) const {
    const size_t numbers = factorCount(p) * Slopes::kStride;
    for (auto* out : {&slopes.value, &slopes.alongX, &slopes.alongY}) out->resize(numbers);
    if (!held(p)) {
        mBases[p].evaluateWithDerivatives(slopes.x.data(), slopes.y.data(), slopes.count, slopes.value.data(),
                                          slopes.alongX.data(), slopes.alongY.data(), Slopes::kStride);
        return;
    }
    const PatchSpline& spline = mMesh.spline(PatchId(p));
    for (int c = 0; c < mMesh.channels(); ++c)
        for (size_t i = 0; i < slopes.count; ++i) {
            const glm::dvec2 at(slopes.x[i], slopes.y[i]), slope = splineGradient(spline, c, at);
            const size_t number = size_t(c) * Slopes::kStride + i;
            slopes.value[number] = evaluateSpline(spline, c, at);
            slopes.alongX[number] = slope.x;
            slopes.alongY[number] = slope.y;
        }
}

// Whether cells of a held patch may be those of others too.
bool EquationBuilder::inReach(PatchId p) const {
    if (!held(p.index)) return true;
    constexpr double kMargin = 2;  // px
    const Rect box = controlBounds(mMesh, p);
    return box.min.x <= mReach.max.x + kMargin && box.min.y <= mReach.max.y + kMargin &&
           box.max.x >= mReach.min.x - kMargin && box.max.y >= mReach.min.y - kMargin;
}

// The jumps that blurred features add: own + weight (other - own), each at the foot. Marks the cells that
// have any as shared.
std::vector<EquationBuilder::Foot> EquationBuilder::findFeet(PatchId p, const PatchCells& cells,
                                                             std::vector<uint8_t>& shared) const {
    std::vector<Foot> feet;
    if (!mBlur.inReach(p)) return feet;
    std::array<BlurTerm, kMaxBlurTerms> terms;
    for (size_t k = 0; k < cells.cells.size(); ++k) {
        const PatchCells::Cell& cell = cells.cells[k];
        for (size_t i = cells.firstSample[k]; i < cells.firstSample[k + 1]; ++i) {
            const int count = mBlur.terms(p, glm::dvec2(cells.at[i]), terms);
            if (count > 0) shared[k] = 1;
            for (int t = 0; t < count; ++t) {
                const BlurTerm& term = terms[size_t(t)];
                const float weight = std::sqrt(cell.area) * cell.share * term.weight;
                feet.push_back({term.own.index, cell.number, -weight, term.ownAt});
                feet.push_back({term.other.index, cell.number, weight, term.otherAt});
            }
        }
    }
    return feet;
}

void EquationBuilder::addFeet(std::vector<Foot> feet, Parts& parts) {
    std::stable_sort(feet.begin(), feet.end(), [](const Foot& a, const Foot& b) {
        return a.patch != b.patch ? a.patch < b.patch : a.cell < b.cell;
    });
    std::vector<float> x, y;
    for (size_t first = 0, last = 0; first < feet.size(); first = last) {
        const uint32_t q = feet[first].patch;
        while (last < feet.size() && feet[last].patch == q) ++last;
        const size_t n = last - first;
        x.resize(n);
        y.resize(n);
        for (size_t i = 0; i < n; ++i) {
            x[i] = feet[first + i].at.x;
            y[i] = feet[first + i].at.y;
        }
        const auto functions = Eigen::Index(factorCount(q));
        Rows values(functions, Eigen::Index(n));
        evaluateFactors(q, x.data(), y.data(), n, values.data());
        Eigen::VectorXf row = Eigen::VectorXf::Zero(functions);
        for (size_t i = 0; i < n; ++i) {
            row += feet[first + i].weight * values.col(Eigen::Index(i));
            if (i + 1 < n && feet[first + i + 1].cell == feet[first + i].cell) continue;
            parts.add(feet[first + i].cell, q, {row.data(), size_t(functions)});
            row.setZero();
        }
    }
}

// An equation counts as its cell's area.
void EquationBuilder::addPatch(PatchId p, const PatchCells& cells, Parts& parts) {
    auto& patch = m.patches[p.index];
    const auto count = Eigen::Index(cells.cells.size());
    const auto functions = Eigen::Index(factorCount(p.index));
    // By cell, its functions in a row.
    const auto stride = Eigen::Index(gramStride(size_t(functions)));
    Eigen::MatrixXf padded = Eigen::MatrixXf::Zero(stride, count);
    auto means = padded.topRows(functions);
    means = sumsOverCells(p.index, cells);

    // Cells that are not the patch's alone.
    std::vector<uint8_t> shared(cells.cells.size());
    for (size_t k = 0; k < shared.size(); ++k)
        shared[k] = cells.cells[k].coverage < 1 - .5F * cells.cells[k].share;
    std::vector<Foot> feet = findFeet(p, cells, shared);
    Eigen::MatrixXf targets = Eigen::MatrixXf::Zero(count, mMesh.channels());
    double covered = 0;  // px^2
    for (Eigen::Index k = 0; k < count; ++k) {
        const PatchCells::Cell& cell = cells.cells[size_t(k)];
        const float root = std::sqrt(cell.area);
        covered += double(cell.coverage) * double(cell.area);
        means.col(k) *= root * cell.share;
        if (shared[size_t(k)]) {
            parts.add(cell.number, p.index, {means.col(k).data(), size_t(functions)});
            means.col(k).setZero();
        } else {
            for (int c = 0; c < mMesh.channels(); ++c)
                targets(k, c) = root * mPicture.means.plane(c)[cell.number];
        }
    }
    addFeet(std::move(feet), parts);
    if (held(p.index)) return;
    patch.gram = gram({padded.data(), size_t(padded.size())}, size_t(count), size_t(functions));
    const double area = std::max(1.0, covered);
    for (int k = 0; k < patch.count; ++k)
        patch.damping[size_t(k)] = kRidge * area + kBending / area * mBases[p.index].energy(k);
    Eigen::Map<Eigen::MatrixXd>(patch.moments.data(), patch.count, mMesh.channels()) =
        (means * targets).cast<double>();
}

bool EquationBuilder::addUnknowns(const ProgressPart& progress) {
    m.patches.resize(mChoices.size());
    mBases.assign(mChoices.size(), noBasis());
    std::atomic<size_t> done = 0;
    parallelFor(mChoices.size(), 16, [&](size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) {
            if (!progress.step(double(done++) / double(mChoices.size()))) return;
            if (!mMesh.connectivity().alive(PatchId(uint32_t(p))) || mChoices[p].sites.empty()) continue;
            mBases[p] = NewtonBasis(mChoices[p].sites);
            auto& patch = m.patches[p];
            patch.count = int(mChoices[p].sites.size());
            const auto count = size_t(patch.count);
            patch.gram.assign(count * count, 0);
            patch.moments.assign(count * size_t(mMesh.channels()), 0);
            patch.damping.assign(count, kRidge);
        }
    });
    for (uint32_t p = 0; p < m.patches.size(); ++p)
        if (!held(p)) reach(controlBounds(mMesh, PatchId(p)));
    return !progress.stopRequested();
}

void EquationBuilder::addCells(const ProgressPart& progress) {
    const CellSampler sampler(mMesh, mPicture.grid, mSide);
    const size_t first = mParts.size();
    mParts.resize(first + sampler.patches().size());
    std::atomic<size_t> done = 0;
    parallelFor(sampler.patches().size(), 4, [&](size_t begin, size_t end) {
        PatchCells cells;
        for (size_t i = begin; i < end; ++i) {
            if (!progress.step(double(done++) / double(sampler.patches().size()))) return;
            if (!inReach(sampler.patches()[i])) continue;
            sampler.sample(i, cells);
            if (cells.cells.empty()) continue;
            addPatch(sampler.patches()[i], cells, mParts[first + i]);
            mParts[first + i].shrink();
        }
    });
    m.cellRows = uint32_t(mPicture.means.planeSize());
}

// One patch's side of a seam: colours, and derivatives across the edge.
void EquationBuilder::addSide(HalfedgeId h, const ColorEquations::Seam& seam, double sign,
                              const SeamWeights& weights, Parts& parts) {
    const uint32_t samples = seam.points;
    const HalfedgeMesh& mesh = mMesh.connectivity();
    const PatchId p = mesh.face(h);
    const auto sides = mesh.sides(p);
    const int side = int(std::find(sides.begin(), sides.end(), h) - sides.begin());
    const bool reversed = HalfedgeMesh::halfedge(HalfedgeMesh::edge(h)) != h;
    const BezierTriangle t = toPixels(mMesh.controlPoints(p));
    const BezierCurve curve = toPixels(mMesh.controlPoints(HalfedgeMesh::halfedge(HalfedgeMesh::edge(h))));
    const auto alongEdge = [&](uint32_t i) { return double(i) / double(samples - 1); };
    const auto pointAt = [&](uint32_t i) {
        Barycentric b(0);
        const double s = reversed ? 1 - alongEdge(i) : alongEdge(i);
        b[side] = 1 - s;
        b[(side + 1) % 3] = s;
        return b;
    };
    Slopes slopes;
    slopes.count = samples;
    for (uint32_t i = 0; i < samples; ++i) {
        const glm::dvec2 at = domainPoint(pointAt(i));
        slopes.x[i] = float(at.x);
        slopes.y[i] = float(at.y);
    }
    evaluateSlopes(p.index, slopes);
    const size_t n = factorCount(p.index);
    std::vector<float> row(n);
    for (uint32_t i = 0; i < samples; ++i) {
        const double weight = sign * std::sqrt(weights.colour * seam.length(i));
        for (size_t k = 0; k < n; ++k) row[k] = float(weight * slopes.value[k * Slopes::kStride + i]);
        parts.add(seam.firstRow + i, p.index, row);
    }
    if (weights.gradient == 0) return;
    for (uint32_t i = 0; i < samples; ++i) {
        const double weight = sign * std::sqrt(weights.gradient * seam.length(i));
        // The step in the domain that goes a pixel along the edge's normal: J^-1 normal.
        const PatchPoint at = evaluateWithDerivatives(t, pointAt(i));
        const double det = cross(at.dv, at.dw);
        const glm::dvec2 tangent = curve.derivative(alongEdge(i));
        const double speed = std::sqrt(tangent.x * tangent.x + tangent.y * tangent.y);
        const glm::dvec2 normal = glm::dvec2(-tangent.y, tangent.x) / std::max(1e-9, speed);
        const double dv = det > 1e-9 ? cross(normal, at.dw) / det : 0;
        const double dw = det > 1e-9 ? cross(at.dv, normal) / det : 0;
        const double stepX = dv + .5 * dw, stepY = kDomainHeight * dw;
        for (size_t k = 0; k < n; ++k) {
            const size_t number = k * Slopes::kStride + i;
            row[k] = float(weight * (slopes.alongX[number] * stepX + slopes.alongY[number] * stepY));
        }
        parts.add(seam.firstRow + samples + i, p.index, row);
    }
}

void EquationBuilder::addSeams(const SeamWeights& weights, const ProgressPart& progress) {
    const HalfedgeMesh& mesh = mMesh.connectivity();
    constexpr double kSamplesPerPx = .7;
    // As many as sites along an edge: fewer points would let colours swing between them.
    constexpr int kLeast = kSiteSubdivisions + 1, kMost = kSiteSubdivisions + 5;
    static_assert(kMost <= Slopes::kStride);
    std::vector<HalfedgeId> halfedges;  // of m.seams
    uint32_t rows = m.cellRows;
    mMesh.forEachEdge([&](EdgeId e) {
        if (mesh.onBorder(e) || mMesh.curve(e).feature || mMesh.curve(e).colourBreak) return;
        const HalfedgeId h = HalfedgeMesh::halfedge(e);
        if (held(mesh.face(h).index) && held(mesh.face(HalfedgeMesh::twin(h)).index)) return;
        const double length = toPixels(mMesh.controlPoints(h)).length();
        const int samples = std::clamp(int(length * kSamplesPerPx), kLeast, kMost);
        halfedges.push_back(h);
        m.seams.push_back({rows, uint32_t(samples), length / double(samples - 1), weights.colour});
        rows += uint32_t(weights.gradient > 0 ? 2 * samples : samples);
    });
    const size_t first = mParts.size();
    mParts.resize(first + halfedges.size());
    std::atomic<size_t> done = 0;
    parallelFor(halfedges.size(), 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            if (!progress.step(double(done++) / double(halfedges.size()))) return;
            addSide(halfedges[i], m.seams[i], 1, weights, mParts[first + i]);
            addSide(HalfedgeMesh::twin(halfedges[i]), m.seams[i], -1, weights, mParts[first + i]);
            mParts[first + i].shrink();
        }
    });
}

// One patch's rows side by side, in the order of their ids; its chunks are emptied.
void EquationBuilder::gather(ColorEquations::Patch& patch, const std::vector<Parts::Chunk*>& chunks,
                             const std::vector<uint32_t>& number) {
    struct Place {
        uint32_t id;
        const PackedRows* rows;
        size_t row;
    };
    std::vector<Place> places;
    for (const Parts::Chunk* chunk : chunks)
        for (size_t i = 0; i < chunk->ids.size(); ++i) places.push_back({chunk->ids[i], &chunk->rows, i});
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.id < b.id; });
    for (const Place& place : places)
        if (patch.rowIds.empty() || patch.rowIds.back() != number[place.id])
            patch.rowIds.push_back(number[place.id]);
    patch.rowIds.shrink_to_fit();
    patch.rows.reserve(patch.rowIds.size(), size_t(patch.count));
    std::vector<float> row(size_t(patch.count), 0);
    for (size_t i = 0; i < places.size(); ++i) {
        places[i].rows->addTo(places[i].row, row);
        if (i + 1 < places.size() && places[i + 1].id == places[i].id) continue;
        patch.rows.push(row);
        std::fill(row.begin(), row.end(), 0.0F);
    }
    for (Parts::Chunk* chunk : chunks) *chunk = {};
}

// Brings the parts together: rows numbered densely, each patch's factors side by side.
void EquationBuilder::finish(const ProgressPart& progress) {
    mBases = {};
    releaseFreeMemory();
    std::vector<std::vector<Parts::Chunk*>> chunks(m.patches.size());
    std::vector<uint32_t> number;  // by id
    uint32_t ids = 0;
    for (Parts& parts : mParts)
        for (Parts::Chunk& chunk : parts.chunks) {
            ids = std::max(ids, *std::max_element(chunk.ids.begin(), chunk.ids.end()) + 1);
            chunks[chunk.patch].push_back(&chunk);
        }
    // Rows of held patches alone say nothing.
    constexpr uint32_t kNoRow = ~uint32_t{0};
    number.assign(ids, kNoRow);
    for (const Parts& parts : mParts)
        for (const Parts::Chunk& chunk : parts.chunks)
            if (!held(chunk.patch))
                for (const uint32_t id : chunk.ids) number[id] = 0;
    uint32_t rows = 0;
    std::vector<uint32_t> idOfRow;
    for (uint32_t id = 0; id < ids; ++id) {
        if (number[id] == kNoRow) continue;
        number[id] = rows++;
        idOfRow.push_back(id);
    }
    m.rowCount = rows;
    m.targets.assign(size_t(rows) * size_t(mMesh.channels()), 0);
    for (uint32_t row = 0; row < rows && idOfRow[row] < m.cellRows; ++row) {
        const float root = std::sqrt(mPicture.grid.area(idOfRow[row]));
        for (int c = 0; c < mMesh.channels(); ++c)
            m.targets[size_t(c) * rows + row] = root * mPicture.means.plane(c)[idOfRow[row]];
    }
    for (const Parts& parts : mParts)
        for (const Parts::Chunk& chunk : parts.chunks)
            for (size_t i = 0; held(chunk.patch) && i < chunk.ids.size(); ++i) {
                if (number[chunk.ids[i]] == kNoRow) continue;
                std::array<float, kMaxChannels> colours{};
                const auto channels = size_t(mMesh.channels());
                chunk.rows.addTo(i, {colours.data(), channels});
                for (size_t c = 0; c < channels; ++c)
                    m.targets[c * rows + number[chunk.ids[i]]] -= colours[c];
            }
    for (ColorEquations::Seam& seam : m.seams) seam.firstRow = number[seam.firstRow];
    m.cellRows = uint32_t(std::lower_bound(idOfRow.begin(), idOfRow.end(), m.cellRows) - idOfRow.begin());

    parallelFor(m.patches.size(), 16, [&](size_t begin, size_t end) {
        for (size_t p = begin; p < end && !progress.stopRequested(); ++p)
            if (!held(uint32_t(p))) gather(m.patches[p], chunks[p], number);
    });
    m.firstEntry.assign(size_t(rows) + 1, 0);
    for (const auto& patch : m.patches)
        for (const uint32_t row : patch.rowIds) ++m.firstEntry[row + 1];
    for (size_t row = 0; row < rows; ++row) m.firstEntry[row + 1] += m.firstEntry[row];
    m.entries.resize(m.firstEntry.back());
    std::vector<uint32_t> fill(m.firstEntry.begin(), m.firstEntry.end() - 1);
    for (uint32_t p = 0; p < m.patches.size(); ++p)
        for (uint32_t i = 0; i < m.patches[p].rowIds.size(); ++i)
            m.entries[fill[m.patches[p].rowIds[i]]++] = {p, i};
}

}  // namespace

ColorEquations buildEquations(const PatchMesh& mesh, const FitPicture& picture,
                              const std::vector<SiteChoice>& choices, const SeamWeights& weights,
                              int samplesPerSide, const ProgressPart& progress) {
    EquationBuilder builder(mesh, picture, choices, samplesPerSide);
    if (!builder.addUnknowns(progress.part(0, .1))) return {};
    builder.addCells(progress.part(.1, .7));
    builder.addSeams(weights, progress.part(.7, .9));
    if (progress.step(.9)) builder.finish(progress);
    return std::move(builder.m);
}

}  // namespace tessera
