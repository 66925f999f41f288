// See resolve_pass.h.
#include "render/resolve_pass.h"

#include <array>
#include <string>
#include <vector>

#include "render/gpu_layout.h"
#include "render/shader_library.h"

namespace tessera::render {

Result<ResolvePass::Variants> ResolvePass::makeVariants(int samples, bool counted) {
    std::vector<std::string> defines{"#define SAMPLES " + std::to_string(samples)};
    if (counted) defines.emplace_back("#define COUNT_EVALUATIONS");
    const std::array<std::string_view, 2> files{"resolve.vert", "resolve.frag"};
    auto plain = makeProgram(files, defines);
    if (!plain) return tl::unexpected(plain.error());
    defines.emplace_back("#define BLUR");
    auto blurred = makeProgram(files, defines);
    if (!blurred) return tl::unexpected(blurred.error());
    return Variants{std::move(*plain), std::move(*blurred)};
}

Result<ResolvePass> ResolvePass::create() {
    ResolvePass pass;
    for (const int samples : {1, 4}) {
        auto programs = makeVariants(samples, false);
        if (!programs) return tl::unexpected(programs.error());
        pass.mPrograms.emplace(samples, std::move(*programs));
    }
    return pass;
}

void ResolvePass::draw(const Variants& programs, const BlurTiles& tiles, glm::ivec2 size) {
    if (tiles.rects.size() > mRects.size()) mRects.resize(tiles.rects.size() * 5 / 4);
    for (size_t i = 0; i < tiles.rects.size(); ++i) mRects.set(i, tiles.rects[i]);
    mRects.upload();
    mRects.bind(Unit::Rects);
    const auto drawRects = [&](const Program& program, size_t begin, size_t end) {
        if (begin == end) return;
        glUseProgram(program.name());
        glUniform1i(0, GLint(begin));
        glUniform2f(1, float(size.x), float(size.y));
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(end - begin));
    };
    drawRects(programs.plain, 0, tiles.plain);
    drawRects(programs.blurred, tiles.plain, tiles.rects.size());
}

void ResolvePass::run(const BlurTiles& tiles, glm::ivec2 size, int samples) {
    draw(mPrograms.at(samples), tiles, size);
}

Result<EvaluationCounts> ResolvePass::runCounted(const BlurTiles& tiles, glm::ivec2 size, int samples) {
    if (!mCountedPrograms.contains(samples)) {
        auto programs = makeVariants(samples, true);
        if (!programs) return tl::unexpected(programs.error());
        mCountedPrograms.emplace(samples, std::move(*programs));
    }
    Buffer counters;
    counters.reserve(sizeof(EvaluationCounts));
    EvaluationCounts counts;
    counters.write(0, &counts, sizeof(counts));
    counters.bindStorage(Binding::Counters);
    draw(mCountedPrograms.at(samples), tiles, size);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    counters.read(std::span(&counts, 1));
    return counts;
}

}  // namespace tessera::render
