// Which pixel centres each patch owns: every edge's curve is intersected with the rows of pixel centres ONCE,
// and both patches beside it use the same crossings, so that they neither gap nor overlap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/view.h"

namespace tessera {

// Output coordinates counted from the picture's corner, not the view's, in 1/65536 output pixel: views of one
// scale whose origins are whole output pixels apart see the same numbers, so that tiles fit together exactly.
struct PixelGrid {
    static constexpr int kBits = 16;
    static constexpr int64_t kOne = int64_t{1} << kBits;

    // The view's scale must be positive. Coordinates beyond 2^60 units are clamped (nothing of a picture is
    // there).
    explicit PixelGrid(const View& view);

    int64_t fixedX(double imageX) const;
    int64_t fixedY(double imageY) const;
    // The first column or row whose centre is at or beyond a coordinate, limited to 0 .. width or height.
    int column(int64_t x) const;
    int row(int64_t y) const;
    // The image point of a pixel centre. Exact but for one rounding.
    double centreX(int column) const { return (double(originX + kOne / 2) + double(column) * kOne) * pixelX; }
    double centreY(int row) const { return (double(originY + kOne / 2) + double(row) * kOne) * pixelY; }

    int width, height;
    glm::dvec2 scale;
    double unitX, unitY;    // grid units per image pixel
    double pixelX, pixelY;  // image pixels per grid unit
    int64_t originX, originY;
};

// A run of pixels in a row: columns [begin, end).
struct PixelRun {
    int row = 0;
    int begin = 0;
    int end = 0;
};

struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // [x0, x1) x [y0, y1)

    bool empty() const { return x0 >= x1 || y0 >= y1; }
};

// The crossings of all edges of the patches that can be seen. A pixel whose centre lies on a curve belongs to
// the patch on its right, or below where the curve is horizontal.
class ScanConversion {
  public:
    // Keeps a reference to the mesh.
    ScanConversion(const PatchMesh& mesh, const View& view);

    const PixelGrid& grid() const { return mGrid; }
    // Patches whose control box meets the view, by ascending id.
    const std::vector<PatchId>& patches() const { return mVisible; }
    // The pixels whose centres the control box of visible patch i (an index into patches()) can hold.
    const PixelRect& bounds(size_t i) const { return mBounds[i]; }

    // The runs of pixels of a visible patch inside `rect`, row by row. Every pixel centre in the picture is
    // in a run of at least one patch: along any row the crossings of all patches cancel but for those of the
    // picture's border. It can be in several where a patch is thinner than the grid's rounding; the smallest
    // id owns it.
    void runs(PatchId p, const PixelRect& rect, std::vector<PixelRun>& result) const;

  private:
    // A part of an edge's curve along which y does not turn: for each row [row0, row1) its column.
    struct Piece {
        int row0 = 0, row1 = 0;
        int8_t sign = 0;  // 1 where y grows in the edge's direction
        bool straight = false;
        double t0 = 0, t1 = 1;
        size_t first = 0;  // in mColumns
    };
    static constexpr int kMaxPieces = 3;

    int findPieces(EdgeId e, Piece* pieces) const;
    void fillColumns(EdgeId e, const Piece& piece);
    void fillStraight(EdgeId e, const Piece& piece);

    const PatchMesh& mMesh;
    PixelGrid mGrid;
    std::vector<PatchId> mVisible;
    std::vector<PixelRect> mBounds;
    std::vector<uint32_t> mFirstPiece;  // by edge id, into mPieces
    std::vector<Piece> mPieces;
    std::vector<int32_t> mColumns;
};

}  // namespace tessera
