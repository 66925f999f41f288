// The linear least squares of the colour fit: an equation for each cell, which is the mean of the colours
// over it, and equations by which patches agree along edges that are no features.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/mesh/edge_blur.h"
#include "core/mesh/patch_mesh.h"
#include "core/vectorize/fit_picture.h"
#include "core/vectorize/packed_rows.h"
#include "core/vectorize/site_pursuit.h"

namespace tessera {

// The unknowns are the Newton factors (core/mesh/newton_basis.h) of each patch and channel; channels are
// independent of each other. An equation of one patch alone goes into its Gram matrix. One of several patches
// (a cell across an edge or near a blurred feature, a point of a seam) is a row, whose factors lie with the
// patches.
struct ColorEquations {
    // Matrices lie row after row.
    struct Patch {
        int count = 0;                 // of unknowns: the most that a channel has
        std::vector<float> gram;       // (count x count), symmetric; sums of floats
        std::vector<double> damping;   // count: to be added to its diagonal
        std::vector<double> moments;   // (channels x count)
        std::vector<uint32_t> rowIds;  // ascending
        PackedRows rows;               // (rowIds.size() x count)
    };
    struct Entry {
        uint32_t patch;
        uint32_t place;  // in its rowIds
    };

    std::vector<Patch> patches;        // by patch id; count 0 where there is none
    std::vector<uint32_t> firstEntry;  // by row, into entries
    std::vector<Entry> entries;
    size_t rowCount = 0;
    std::vector<float> targets;  // (channels x rowCount)
    uint32_t cellRows = 0;       // rows from here on are of seams
    // The rows of one edge: the colours at points evenly spaced from end to end, then, where they have a
    // weight, the gradients there. The square of what a row of colours comes to is
    // weight * length * difference^2.
    struct Seam {
        uint32_t firstRow, points;
        double spacing;  // px
        double weight;

        double length(uint32_t point) const {
            return point == 0 || point + 1 == points ? .5 * spacing : spacing;
        }
    };
    std::vector<Seam> seams;
};

struct SeamWeights {
    double colour = 1;    // C0: of a squared difference over a pixel of edge, against a pixel's squared error
    double gradient = 0;  // C1: the same, of the difference a pixel off the edge
};

// `picture` in the mesh's basis; samplesPerSide^2 samples a square of its grid. Patches whose choice has no
// sites are held: they have no unknowns, and the colours that they have count as known. Void where progress
// says stop.
ColorEquations buildEquations(const PatchMesh& mesh, const FitPicture& picture,
                              const std::vector<SiteChoice>& choices, const SeamWeights& weights,
                              int samplesPerSide, const ProgressPart& progress);

}  // namespace tessera
