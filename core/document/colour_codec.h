// Colour splines to and from a range-coded stream.
//
// A spline of the default centres is stored as its values at the centres, rounded to a step: nodal values are
// well conditioned, so that rounding moves no colour by more than the step times half the Lebesgue constant,
// while rounding the coefficients would. Every other spline (centres of its own, values so large that floats
// are coarser than the step) is stored as the floats that it is.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/document/file_mesh.h"
#include "core/document/range_coder.h"
#include "core/mesh/tps.h"

namespace tessera {

// No colour of a patch moves by more than this through being stored: 0.1 level.
constexpr double kColourBound = .1 / 255;

// The step for new documents: the largest that keeps kColourBound for all of the default layouts (3 to 16
// centres).
double defaultColourStep();

// The largest sum of |cardinal functions| over the domain of the spline through the first n default centres,
// 3 <= n <= 16; for fewer terms than that the spline is the plane through the corners, n = 3. Computed on a
// grid and rounded up.
double lebesgueConstant(int n);

struct FileColour {
    std::array<uint8_t, kMaxChannels> terms{};
    bool exact = false;                                     // floats instead of values
    std::array<std::vector<int64_t>, kMaxChannels> values;  // max(3, terms) of each channel, in steps
    std::vector<glm::vec2> centres;                         // exact: as in PatchSpline
    std::vector<float> coefficients;                        // exact
};

// Between a patch's spline and what is stored of it. quantized(dequantized(x)) is x for all x that
// quantized() gives. The spline must have finite numbers and the sizes that its terms ask for (see
// splineViolation).
FileColour quantized(const PatchSpline& spline, int channels, double step);
PatchSpline dequantized(const FileColour& colour, int channels, double step);

// What is wrong with a spline's sizes and numbers, or empty.
std::string splineViolation(const PatchSpline& spline, int channels);

// Both directions return what is wrong, or empty. Decoding sizes the array by the mesh.
std::string encodeColours(RangeEncoder& coder, const FileMesh& mesh, const std::vector<bool>& featureEdges,
                          int channels, std::vector<FileColour>& colours);
std::string decodeColours(RangeDecoder& coder, const FileMesh& mesh, const std::vector<bool>& featureEdges,
                          int channels, std::vector<FileColour>& colours);

}  // namespace tessera
