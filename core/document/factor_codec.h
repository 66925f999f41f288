// Colour splines on chosen sites to and from a range-coded stream: the method from version 2 on.
//
// A channel of n terms is stored as its n Newton factors (newton_basis.h), which fall off quickly and of
// which a smaller number makes a coarser spline. Each factor has a step of its own, so that the mean squared
// error is the same for all of them and for all patches: large patches have small steps. The rounding of one
// factor is made good by the ones after it as far as they can (Babai's nearest plane).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/document/file_mesh.h"
#include "core/document/format_version.h"
#include "core/document/geometry_codec.h"
#include "core/document/range_coder.h"
#include "core/document/site_basis.h"
#include "core/mesh/tps.h"

namespace tessera {

struct FactorColour {
    bool exact = false;                          // floats instead of factors
    std::array<uint8_t, kMaxChannels> counts{};  // of factors of each channel, at least 3
    std::vector<uint8_t> sites;                  // the corners first; as many as the largest count
    std::array<std::vector<int32_t>, kMaxChannels> factors;  // in steps, in the order of the SiteBasis
    PatchSpline spline;                                      // exact: what it is
};

// Each patch's area by its control points, as a share of the mean one; from 1/16 to 16.
std::vector<double> relativeAreas(const FileMesh& mesh, const FileGeometry& geometry);

// The step at which rounding adds `squaredError` to the mean over the picture of the squared error, summed
// over the channels, where patches have `factors` factors on the average.
double factorStep(double squaredError, double factors);

// What the factors of a patch are measured in, and what they say.
class FactorBasis {
  public:
    // Of the colour's counts and sites, which may be in any order that a SiteBasis takes.
    FactorBasis(uint32_t version, const FactorColour& colour, int channels, double step, double area);

    const SiteBasis& basis() const { return mBasis; }
    int channels() const { return int(mSteps.size()); }
    // Of channel c's factors, in colour units.
    std::span<const double> steps(size_t c) const { return mSteps[c]; }
    std::vector<double> values(size_t c, std::span<const int32_t> factors) const;

    // The spline of these values around the lattice's border.
    void evaluateBorder(std::span<const double> values, std::span<double> out) const;
    PatchSpline spline(const std::array<std::vector<int32_t>, kMaxChannels>& factors) const;

  private:
    SiteBasis mBasis;
    std::vector<std::vector<double>> mSteps;
    std::vector<double> mOnBorder;  // before version 4: the functions there
};

// A spline's factors at the steps that `step` and the patch's relative area give; exact where it has centres
// of other kinds, or numbers that do not survive: the spline of the factors has the same factors again.
FactorColour quantizedFactors(const PatchSpline& spline, int channels, double step, double area);

// Both directions return what is wrong, or empty; `streamBytes` is the length of the stream, by which the
// number of factors is bounded. The encoder takes the current version alone. The decoder sets the splines
// too, whose sites are of the version's lattice.
struct FactorStream {
    const FileMesh& mesh;
    const std::vector<bool>& featureEdges;
    const std::vector<double>& areas;
    int channels = 3;
    double step = 0;
    uint32_t version = kFormatVersion;
};
std::string encodeFactors(RangeEncoder& coder, const FactorStream& stream,
                          std::vector<FactorColour>& colours);
std::string decodeFactors(RangeDecoder& coder, const FactorStream& stream, size_t streamBytes,
                          std::vector<PatchSpline>& splines);

// Zeros follow a stream that is shorter than this, so that a reader can bound what it takes.
size_t leastFactorBytes(const std::vector<FactorColour>& colours, int channels);

}  // namespace tessera
