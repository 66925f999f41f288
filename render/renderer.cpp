// See renderer.h.
#include "render/renderer.h"

#include <optional>

#include "core/base/check.h"
#include "core/mesh/edge_blur.h"
#include "render/compute_subdivision.h"
#include "render/gl_objects.h"
#include "render/gpu_layout.h"
#include "render/lod_pass.h"
#include "render/offscreen_gl.h"
#include "render/patch_buffers.h"
#include "render/patch_pass.h"

namespace tessera::render {

struct Renderer::State {
    LodPass lod;
    PatchPass patches;
    ResolvePass resolve;
    std::optional<ComputeSubdivision> subdivision;  // made when it is first asked for
    PatchBuffers buffers;
    VisibilityBuffer visibility;
    VertexArray vertexArray = makeVertexArray();  // without attributes; core profiles want one bound
    Buffer viewBlock;
    PatchMesh mesh;  // a snapshot
    double sharpen = 1;
    size_t uploadedBytes = 0;

    GpuView block{};  // of the frame

    void prepare(const View& view, const DrawOptions& options, glm::ivec2 target);
    Result<void> drawVisibility(const DrawOptions& options);
};

Renderer::Renderer(std::unique_ptr<State> state) : mState(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create() {
    if (const auto fit = checkCurrentContext(); !fit) return tl::unexpected(fit.error());
    auto lod = LodPass::create();
    if (!lod) return tl::unexpected(lod.error());
    auto patches = PatchPass::create();
    if (!patches) return tl::unexpected(patches.error());
    auto resolve = ResolvePass::create();
    if (!resolve) return tl::unexpected(resolve.error());
    auto state = std::make_unique<State>();
    state->lod = std::move(*lod);
    state->patches = std::move(*patches);
    state->resolve = std::move(*resolve);
    return Renderer(std::move(state));
}

void Renderer::setMesh(const PatchMesh& mesh) {
    mState->mesh = mesh;
    mState->buffers.setMesh(mesh, mState->sharpen);
}

void Renderer::update(const PatchMesh& mesh, std::span<const PatchId> patches) {
    mState->mesh = mesh;
    mState->buffers.update(mesh, patches, mState->sharpen);
}

size_t Renderer::uploadedBytes() const {
    return mState->uploadedBytes;
}

void Renderer::State::prepare(const View& view, const DrawOptions& options, glm::ivec2 target) {
    TESSERA_CHECK(options.samples == 1 || options.samples == 4);
    if (options.sharpen != sharpen) {
        sharpen = options.sharpen;
        buffers.setBlur(mesh, sharpen);
    }
    uploadedBytes = buffers.upload();
    const int perSide = options.samples == 4 ? 2 : 1;
    block = gpuView(mesh, view, perSide, target);
    block.patchCount = uint32_t(buffers.patchCount());
    block.edgeCount = uint32_t(buffers.edgeCount());
    lod.plan(block);
    block.showHidden = options.showHidden;
    viewBlock.reserve(sizeof(block));
    viewBlock.write(0, &block, sizeof(block));
    visibility.resize(view.width * perSide, view.height * perSide);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, viewBlock.name());
    glBindVertexArray(vertexArray.name());
    buffers.bind();
}

Result<void> Renderer::State::drawVisibility(const DrawOptions& options) {
    visibility.begin();
    if (buffers.patchCount() == 0) return {};
    if (!options.computeSubdivision) {
        patches.run(lod.run(block));
        return {};
    }
    if (!subdivision) {
        auto made = ComputeSubdivision::create();
        if (!made) return tl::unexpected(made.error());
        subdivision = std::move(*made);
    }
    subdivision->run(visibility.texture(), buffers.patchCount());
    return {};
}

namespace {

// Draws a frame; resolve(tiles, size) draws the colours from the visibility buffer.
template <class State, class Resolve>
Result<void> drawFrame(State& state, const View& view, const DrawOptions& options, Resolve&& resolve) {
    if (view.width <= 0 || view.height <= 0) return {};
    const StateScope scope;
    const auto viewport = scope.viewport();
    state.prepare(view, options, {viewport[0], viewport[1]});
    if (auto drawn = state.drawVisibility(options); !drawn) return drawn;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(scope.drawFramebuffer()));
    glViewport(viewport[0], viewport[1], view.width, view.height);
    glBindTextureUnit(GLuint(Unit::Visibility), state.visibility.texture().name());
    resolve(blurTiles(*edgeBlurOf(state.mesh, state.sharpen), view), glm::ivec2(view.width, view.height));
    return {};
}

}  // namespace

Result<void> Renderer::draw(const View& view, const DrawOptions& options) {
    return drawFrame(*mState, view, options, [&](const BlurTiles& tiles, glm::ivec2 size) {
        mState->resolve.run(tiles, size, options.samples);
    });
}

Result<EvaluationCounts> Renderer::drawCounted(const View& view, const DrawOptions& options) {
    Result<EvaluationCounts> counts;
    const auto drawn = drawFrame(*mState, view, options, [&](const BlurTiles& tiles, glm::ivec2 size) {
        counts = mState->resolve.runCounted(tiles, size, options.samples);
    });
    if (!drawn) return tl::unexpected(drawn.error());
    return counts;
}

}  // namespace tessera::render
