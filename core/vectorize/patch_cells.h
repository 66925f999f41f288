// The cells of each patch as the colour fit sees them (fit_picture.h): a cell's mean is taken over a regular
// grid of samples, each in one patch.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "core/mesh/patch_mesh.h"
#include "core/mesh/scan_conversion.h"
#include "core/vectorize/fit_picture.h"

namespace tessera {

struct PatchCells {
    struct Cell {
        uint32_t number;
        float area;      // px^2
        float share;     // of each of its samples, 1 over their number
        float coverage;  // share of its samples that lie in the patch
    };
    std::vector<Cell> cells;
    // The samples, cell by cell, those of cells[k] from firstSample[k] to firstSample[k + 1]: their image
    // point and parametric domain point.
    std::vector<uint32_t> firstSample;
    std::vector<glm::vec2> at;
    std::vector<float> x, y;
};

class CellSampler {
  public:
    // samplesPerSide^2 samples a square of the grid. Keeps references to the mesh and the grid.
    CellSampler(const PatchMesh& mesh, const FitGrid& grid, int samplesPerSide);

    const std::vector<PatchId>& patches() const { return mScan.patches(); }
    // Of patches()[i]; thread-safe.
    void sample(size_t i, PatchCells& result) const;

  private:
    // A sample and its cell, a place in PatchCells::cells.
    struct Sample {
        uint32_t cell;
        glm::vec2 at;
    };
    void addSamples(const PixelRun& run, const PixelRect& squares, std::vector<uint32_t>& places,
                    std::vector<PatchCells::Cell>& cells, std::vector<Sample>& samples) const;

    const PatchMesh& mMesh;
    const FitGrid& mGrid;
    int mSide;
    ScanConversion mScan;
};

}  // namespace tessera
