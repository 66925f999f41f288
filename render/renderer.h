// Draws a mesh with OpenGL 4.5 (paper section 5): patches tessellated by need into a visibility buffer, then
// one evaluation of a spline a pixel. The same picture as core/export/rasterize, which is its oracle.
#pragma once

#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/mesh/patch_mesh.h"
#include "core/mesh/view.h"
#include "render/resolve_pass.h"

namespace tessera::render {

struct DrawOptions {
    int samples = 4;         // per pixel: 1 (its centre) or 4 (a regular grid, averaged)
    double sharpen = 1;      // multiplies the blur of every feature; 0 draws hard features
    bool showHidden = true;  // whether hidden patches are drawn as any other; those cut out never are
    // By the paper's own 4-way subdivision in a compute shader instead of the tessellator: slower, for
    // comparison.
    bool computeSubdivision = false;
};

// All functions but setMesh and update, and the destructor too, need the context that create() was
// called in to be current. What a frame changes in it is put back (StateScope in gl_objects.h says what), so
// that a toolkit's context will do.
class Renderer {
  public:
    // Internal where the current context is not good enough or its driver refuses a shader: draw with the CPU
    // then.
    static Result<Renderer> create();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    ~Renderer();

    // Takes over a mesh; needed where connectivity, size or colour basis changed. Nothing is uploaded
    // before the next frame.
    void setMesh(const PatchMesh& mesh);
    // The mesh after an edit that changed these patches alone, in geometry, colour or attributes.
    void update(const PatchMesh& mesh, std::span<const PatchId> patches);

    // Draws over the viewport of the framebuffer that is bound for drawing, whose size is the view's, the
    // picture's top at the viewport's: values in the working space, premultiplied, not clamped by us, 0
    // outside the picture. Without blending.
    // Internal, and nothing drawn, where the driver refuses what an option needs.
    Result<void> draw(const View& view, const DrawOptions& options = {});
    // The same, and how many splines that took.
    Result<EvaluationCounts> drawCounted(const View& view, const DrawOptions& options = {});

    // Bytes that the last frame uploaded.
    size_t uploadedBytes() const;

  private:
    struct State;
    explicit Renderer(std::unique_ptr<State> state);

    std::unique_ptr<State> mState;
};

}  // namespace tessera::render
