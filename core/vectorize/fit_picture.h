// What the colour fit asks of a picture: its means over the cells of a grid. Cells are pixels, or parts of
// them where patches have few pixels for their terms: means over whole pixels leave open what lies between,
// and splines would swing there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/image/image.h"
#include "core/mesh/patch_mesh.h"

namespace tessera {

// Squares, perSide x perSide of them a pixel. A pixel's squares are a cell each, or one cell together.
struct FitGrid {
    int width = 0, height = 0;  // px
    int perSide = 1;
    std::vector<uint8_t> whole;  // by pixel: 1 where its squares are one cell; empty if nowhere

    // Cells are numbered as squares are, row by row; one of several squares as the first of them.
    uint32_t cellAt(int column, int row) const {
        if (isWhole(column / perSide, row / perSide)) {
            column -= column % perSide;
            row -= row % perSide;
        }
        return uint32_t(row) * uint32_t(width * perSide) + uint32_t(column);
    }
    // In px^2.
    float area(uint32_t cell) const {
        const uint32_t columns = uint32_t(width * perSide);
        const bool one = isWhole(int(cell % columns) / perSide, int(cell / columns) / perSide);
        return one ? 1.0F : 1 / float(perSide * perSide);
    }

  private:
    bool isWhole(int x, int y) const {
        return perSide == 1 || (!whole.empty() && whole[size_t(y) * size_t(width) + size_t(x)] != 0);
    }
};

struct FitPicture {
    FitGrid grid;
    Image means;  // a pixel for each square; a cell's mean is at its number

    // Each pixel is a cell.
    explicit FitPicture(Image picture)
        : grid{picture.width(), picture.height(), 1, {}}, means(std::move(picture)) {}
    // `fine` is `picture` enlarged by a whole factor (between pixels as one expects it there: enlargedMeans
    // of resample.h). Pixels stay whole near features of the mesh, where no enlargement knows on which side
    // of them it is, and in patches so wide that for termsPerPatch no two rows of places for centres lie
    // closer than pixels do.
    FitPicture(const PatchMesh& mesh, double termsPerPatch, const Image& picture, Image fine);
};

// Into how many squares a side pixels are cut, so that a patch has some of them for each place where its
// splines may have a centre; 1 to 3.
int squaresPerSide(const PatchMesh& mesh, double termsPerPatch);

}  // namespace tessera
