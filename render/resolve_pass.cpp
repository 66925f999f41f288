// See resolve_pass.h.
#include "render/resolve_pass.h"

#include <array>
#include <string>
#include <vector>

#include "render/gpu_layout.h"
#include "render/shader_library.h"

namespace tessera::render {

namespace {

void drawOverViewport(const Program& program) {
    glUseProgram(program.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace

Result<Program> ResolvePass::makeVariant(int samples, bool counted) {
    std::vector<std::string> defines{"#define SAMPLES " + std::to_string(samples)};
    if (counted) defines.emplace_back("#define COUNT_EVALUATIONS");
    return makeProgram(std::array<std::string_view, 2>{"resolve.vert", "resolve.frag"}, defines);
}

Result<ResolvePass> ResolvePass::create() {
    ResolvePass pass;
    for (const int samples : {1, 4}) {
        auto program = makeVariant(samples, false);
        if (!program) return tl::unexpected(program.error());
        pass.mPrograms.emplace(samples, std::move(*program));
    }
    return pass;
}

void ResolvePass::run(int samples) const {
    drawOverViewport(mPrograms.at(samples));
}

Result<EvaluationCounts> ResolvePass::runCounted(int samples) {
    if (!mCountedPrograms.contains(samples)) {
        auto program = makeVariant(samples, true);
        if (!program) return tl::unexpected(program.error());
        mCountedPrograms.emplace(samples, std::move(*program));
    }
    Buffer counters;
    counters.reserve(sizeof(EvaluationCounts));
    EvaluationCounts counts;
    counters.write(0, &counts, sizeof(counts));
    counters.bindStorage(Binding::Counters);
    drawOverViewport(mCountedPrograms.at(samples));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    counters.read(std::span(&counts, 1));
    return counts;
}

}  // namespace tessera::render
