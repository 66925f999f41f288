// See scan_conversion.h.
#include "core/mesh/scan_conversion.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace tessera {

namespace {

__extension__ typedef __int128 Wide;

constexpr double kLimit = double(int64_t{1} << 60);

int64_t rounded(double x) {
    return int64_t(std::llround(std::clamp(x, -kLimit, kLimit)));
}

// The first whole number n with n + 1/2 >= x, x and 1/2 in grid units.
int64_t firstCentre(int64_t x) {
    return (x + PixelGrid::kOne / 2 - 1) >> PixelGrid::kBits;
}

// One coordinate of a curve, in output pixels from its first point: ((a t + b) t + c) t.
struct Cubic {
    double a, b, c;

    Cubic(double d1, double d2, double d3) : a(d3 - 3 * d2 + 3 * d1), b(3 * (d2 - 2 * d1)), c(3 * d1) {}
    double at(double t) const { return ((a * t + b) * t + c) * t; }
    double slope(double t) const { return (3 * a * t + 2 * b) * t + c; }
};

// An edge's curve in output pixels from its first point.
struct EdgeCubic {
    Cubic x, y;
    bool straight;  // within 1/1000 output pixel of the segment between its ends

    EdgeCubic(const std::array<LatticePoint, 4>& p, glm::dvec2 scale)
        : EdgeCubic(scale * toPixels(p[1] - p[0]), scale * toPixels(p[2] - p[0]),
                    scale * toPixels(p[3] - p[0])) {}

  private:
    EdgeCubic(glm::dvec2 d1, glm::dvec2 d2, glm::dvec2 d3) : x(d1.x, d2.x, d3.x), y(d1.y, d2.y, d3.y) {
        // The part of the control net off the chord; along the chord it changes the speed only, but may turn
        // back.
        constexpr double kTolerance = 1e-3;
        const auto offChord = [&](glm::dvec2 d) {
            const double length2 = d3.x * d3.x + d3.y * d3.y;
            const double along = length2 > 0 ? (d.x * d3.x + d.y * d3.y) / length2 : 0;
            const glm::dvec2 off = d - std::clamp(along, 0.0, 1.0) * d3;
            return off.x * off.x + off.y * off.y;
        };
        straight = std::max(offChord(d1), offChord(d2)) <= kTolerance * kTolerance;
    }
};

// The t in [lo, hi] with cubic.at(t) = target, where the cubic is monotone: Newton's method from `t`,
// bisecting where it leaves the interval. One end where the target lies outside by rounding. Sets `slope` to
// that near the result.
double solveMonotone(const Cubic& cubic, bool rising, double target, double lo, double hi, double t,
                     double& slope) {
    // A Newton step below this is followed by one of about its square, which nobody would see.
    constexpr double kSmallStep = 1e-6;
    const double tolerance = 1e-9 + 1e-14 * std::abs(target);
    for (int i = 0; i < 60; ++i) {
        const double f = cubic.at(t) - target;
        slope = cubic.slope(t);
        if (std::abs(f) <= tolerance) break;
        if ((f < 0) == rising)
            lo = t;
        else
            hi = t;
        const double step = f / slope, next = t - step;
        if (next > lo && next < hi) {
            t = next;
            if (std::abs(step) < kSmallStep) break;
        } else {
            t = .5 * (lo + hi);
        }
    }
    return t;
}

}  // namespace

PixelGrid::PixelGrid(const View& view)
    : width(view.width),
      height(view.height),
      scale(view.scale),
      unitX(view.scale.x * double(kOne)),
      unitY(view.scale.y * double(kOne)),
      pixelX(1 / unitX),
      pixelY(1 / unitY),
      originX(rounded(view.origin.x * unitX)),
      originY(rounded(view.origin.y * unitY)) {
    TESSERA_CHECK(scale.x > 0 && scale.y > 0 && width >= 0 && height >= 0);
}

int64_t PixelGrid::fixedX(double imageX) const {
    return rounded(imageX * unitX);
}
int64_t PixelGrid::fixedY(double imageY) const {
    return rounded(imageY * unitY);
}

int PixelGrid::column(int64_t x) const {
    return int(std::clamp<int64_t>(firstCentre(x - originX), 0, width));
}
int PixelGrid::row(int64_t y) const {
    return int(std::clamp<int64_t>(firstCentre(y - originY), 0, height));
}

ScanConversion::ScanConversion(const PatchMesh& mesh, const View& view) : mMesh(mesh), mGrid(view) {
    const HalfedgeMesh& c = mesh.connectivity();
    std::vector<uint8_t> seen(c.edgeCapacity(), 0);
    mesh.forEachPatch([&](PatchId p) {
        const LatticeTriangle t = mesh.controlPoints(p);
        LatticePoint lo = t.p[0], hi = t.p[0];
        for (const LatticePoint& q : t.p) {
            lo = {std::min(lo.x, q.x), std::min(lo.y, q.y)};
            hi = {std::max(hi.x, q.x), std::max(hi.y, q.y)};
        }
        // A unit more on each side for the crossings' own rounding.
        const glm::dvec2 from = toPixels(lo), to = toPixels(hi);
        const PixelRect rect{mGrid.column(mGrid.fixedX(from.x) - 2), mGrid.row(mGrid.fixedY(from.y) - 2),
                             mGrid.column(mGrid.fixedX(to.x) + 2), mGrid.row(mGrid.fixedY(to.y) + 2)};
        if (rect.empty()) return;
        mVisible.push_back(p);
        mBounds.push_back(rect);
        for (const HalfedgeId h : c.sides(p)) seen[HalfedgeMesh::edge(h).index] = 1;
    });

    constexpr size_t kGrain = 256;
    std::vector<std::array<Piece, kMaxPieces>> found(c.edgeCapacity());
    mFirstPiece.assign(c.edgeCapacity() + 1, 0);
    parallelFor(c.edgeCapacity(), kGrain, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e)
            if (seen[e]) mFirstPiece[e + 1] = uint32_t(findPieces(EdgeId(uint32_t(e)), found[e].data()));
    });
    for (size_t e = 0; e < c.edgeCapacity(); ++e) mFirstPiece[e + 1] += mFirstPiece[e];
    mPieces.resize(mFirstPiece.back());
    size_t columns = 0;
    for (size_t e = 0; e < c.edgeCapacity(); ++e)
        for (uint32_t i = mFirstPiece[e]; i < mFirstPiece[e + 1]; ++i) {
            mPieces[i] = found[e][i - mFirstPiece[e]];
            mPieces[i].first = columns;
            columns += size_t(mPieces[i].row1 - mPieces[i].row0);
        }
    mColumns.resize(columns);
    parallelFor(c.edgeCapacity(), kGrain, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e)
            for (uint32_t i = mFirstPiece[e]; i < mFirstPiece[e + 1]; ++i)
                fillColumns(EdgeId(uint32_t(e)), mPieces[i]);
    });
}

// Where y turns is rounded to the grid like the edge's ends, and a piece has the rows between its two rounded
// ends: around a patch each row is then crossed as often upwards as downwards, whatever the rounding.
int ScanConversion::findPieces(EdgeId e, Piece* pieces) const {
    const auto p = mMesh.controlPoints(HalfedgeMesh::halfedge(e));
    const EdgeCubic cubic(p, mGrid.scale);
    const int64_t y0 = mGrid.fixedY(toPixels(p[0]).y), y1 = mGrid.fixedY(toPixels(p[3]).y);
    double turns[4] = {0, 1, 1, 1};
    int64_t at[4] = {y0, y1, y1, y1};
    int count = 1;
    if (!cubic.straight) {
        const auto turn = [&](double t) {
            if (!(t > turns[count - 1] && t < 1)) return;
            turns[count] = t;
            at[count] = y0 + rounded(cubic.y.at(t) * double(PixelGrid::kOne));
            ++count;
        };
        // Roots of y' = 3 a t^2 + 2 b t + c in ascending order, without cancellation.
        const double a = 3 * cubic.y.a, b = cubic.y.b, c = cubic.y.c, discriminant = b * b - a * c;
        if (discriminant > 0) {
            const double q = -(b + std::copysign(std::sqrt(discriminant), b));
            const double r0 = a != 0 ? q / a : 2, r1 = q != 0 ? c / q : 2;
            turn(std::min(r0, r1));
            turn(std::max(r0, r1));
        }
        turns[count] = 1;
        at[count] = y1;
    }
    int used = 0;
    for (int i = 0; i < count; ++i) {
        const int a = mGrid.row(at[i]), b = mGrid.row(at[i + 1]);
        if (a == b) continue;
        pieces[used++] = {std::min(a, b),
                          std::max(a, b),
                          int8_t(a < b ? 1 : -1),
                          cubic.straight,
                          turns[i],
                          turns[i + 1],
                          0};
    }
    return used;
}

void ScanConversion::fillColumns(EdgeId e, const Piece& piece) {
    if (piece.straight) return fillStraight(e, piece);
    const auto p = mMesh.controlPoints(HalfedgeMesh::halfedge(e));
    const EdgeCubic cubic(p, mGrid.scale);
    const int64_t x0 = mGrid.fixedX(toPixels(p[0]).x), y0 = mGrid.fixedY(toPixels(p[0]).y);
    const bool rising = piece.sign > 0;
    int32_t* column = mColumns.data() + piece.first;

    // Beyond the view's sides the exact place does not matter.
    const auto [lowest, highest] = std::minmax({p[0].x, p[1].x, p[2].x, p[3].x});
    const int left = mGrid.column(mGrid.fixedX(double(lowest) / kLatticePerPixel) - 2);
    const int right = mGrid.column(mGrid.fixedX(double(highest) / kLatticePerPixel) + 2);
    if (left == right) {
        std::fill_n(column, piece.row1 - piece.row0, left);
        return;
    }
    double lo = piece.t0, hi = piece.t1;
    double t = .5 * (lo + hi), slope = 0;
    for (int row = piece.row0; row < piece.row1; ++row) {
        const int64_t centre = mGrid.originY + row * PixelGrid::kOne + PixelGrid::kOne / 2;
        t = solveMonotone(cubic.y, rising, double(centre - y0) / double(PixelGrid::kOne), lo, hi, t, slope);
        const double x = std::ceil(cubic.x.at(t) * double(PixelGrid::kOne));
        *column++ = mGrid.column(x0 + int64_t(std::clamp(x, -kLimit, kLimit)));
        // The next row's t lies beyond this one, about a pixel along the tangent.
        (rising ? lo : hi) = t;
        const double guess = t + 1 / slope;
        t = guess > lo && guess < hi ? guess : .5 * (lo + hi);
    }
}

// Exact: the crossing is x0 + whole + rest / height in grid units, 0 <= rest < height, stepped from row to
// row.
void ScanConversion::fillStraight(EdgeId e, const Piece& piece) {
    const auto p = mMesh.controlPoints(HalfedgeMesh::halfedge(e));
    int64_t x0 = mGrid.fixedX(toPixels(p[0]).x), y0 = mGrid.fixedY(toPixels(p[0]).y);
    int64_t x1 = mGrid.fixedX(toPixels(p[3]).x), y1 = mGrid.fixedY(toPixels(p[3]).y);
    if (y0 > y1) {
        std::swap(x0, x1);
        std::swap(y0, y1);
    }
    const int64_t width = x1 - x0, height = y1 - y0;
    const int64_t centre = mGrid.originY + piece.row0 * PixelGrid::kOne + PixelGrid::kOne / 2;
    const auto divide = [height](Wide product, int64_t& rest) {
        Wide whole = product / height;
        rest = int64_t(product - whole * height);
        if (rest < 0) {
            rest += height;
            --whole;
        }
        return int64_t(whole);
    };
    int64_t rest = 0, stepRest = 0;
    int64_t whole = divide(Wide(centre - y0) * width, rest);
    const int64_t step = divide(Wide(PixelGrid::kOne) * width, stepRest);
    int32_t* column = mColumns.data() + piece.first;
    for (int row = piece.row0; row < piece.row1; ++row) {
        *column++ = mGrid.column(x0 + whole + (rest > 0 ? 1 : 0));
        whole += step;
        rest += stepRest;
        if (rest >= height) {
            rest -= height;
            ++whole;
        }
    }
}

void ScanConversion::runs(PatchId p, const PixelRect& rect, std::vector<PixelRun>& result) const {
    result.clear();
    // The pieces around the patch, with the sign that adds 1 on its inner side.
    struct Side {
        const Piece* piece;
        int turn;
    };
    Side sides[3 * kMaxPieces];
    int count = 0;
    for (const HalfedgeId h : mMesh.connectivity().sides(p)) {
        const EdgeId e = HalfedgeMesh::edge(h);
        const bool forward = HalfedgeMesh::halfedge(e) == h;
        for (uint32_t i = mFirstPiece[e.index]; i < mFirstPiece[e.index + 1]; ++i) {
            const Piece& piece = mPieces[i];
            if (piece.row1 <= rect.y0 || piece.row0 >= rect.y1) continue;
            // In positive orientation (y down) the inside is on the right of a side that runs up.
            sides[count++] = {&piece, forward ? -piece.sign : piece.sign};
        }
    }
    for (int row = rect.y0; row < rect.y1; ++row) {
        struct Crossing {
            int column;
            int turn;
        };
        Crossing crossings[3 * kMaxPieces];
        int n = 0;
        for (int s = 0; s < count; ++s) {
            const Piece& piece = *sides[s].piece;
            if (row < piece.row0 || row >= piece.row1) continue;
            const Crossing crossing{mColumns[piece.first + size_t(row - piece.row0)], sides[s].turn};
            int i = n++;
            for (; i > 0 && crossings[i - 1].column > crossing.column; --i) crossings[i] = crossings[i - 1];
            crossings[i] = crossing;
        }
        int inside = 0;
        for (int i = 0; i + 1 < n; ++i) {
            inside += crossings[i].turn;
            const int begin = std::max(crossings[i].column, rect.x0);
            const int end = std::min(crossings[i + 1].column, rect.x1);
            if (inside > 0 && begin < end) result.push_back({row, begin, end});
        }
    }
}

}  // namespace tessera
