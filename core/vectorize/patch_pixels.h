// The pixels of each patch as the colour fit sees them: a pixel is the mean of the picture over its square,
// taken as a regular grid of samples, each in one patch.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "core/mesh/patch_mesh.h"
#include "core/mesh/scan_conversion.h"

namespace tessera {

struct PatchPixels {
    struct Pixel {
        uint32_t index;  // y * width + x
        float coverage;  // share of its samples that lie in the patch
    };
    std::vector<Pixel> pixels;
    // The samples: their pixel (a place in `pixels`), image point and parametric domain point.
    std::vector<uint32_t> pixelOf;
    std::vector<glm::vec2> at;
    std::vector<float> x, y;
};

class PixelSampler {
  public:
    // samplesPerSide^2 samples a pixel. Keeps a reference to the mesh.
    PixelSampler(const PatchMesh& mesh, int samplesPerSide);

    const std::vector<PatchId>& patches() const { return mScan.patches(); }
    // Of patches()[i]; thread-safe.
    void sample(size_t i, PatchPixels& result) const;

  private:
    const PatchMesh& mMesh;
    int mSide;
    ScanConversion mScan;
};

}  // namespace tessera
