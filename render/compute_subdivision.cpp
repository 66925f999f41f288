// See compute_subdivision.h.
#include "render/compute_subdivision.h"

#include <utility>
#include <vector>

#include "render/shader_library.h"

namespace tessera::render {

namespace {

constexpr size_t kGroupSize = 64;  // local_size_x
constexpr int kDepths = 15;        // a path has room for 14 subdivisions

// What precedes the pieces of a queue: the dispatch that takes them up, and their count.
struct QueueHead {
    std::array<uint32_t, 3> groups{0, 1, 1};
    uint32_t count = 0;
};

}  // namespace

Result<ComputeSubdivision> ComputeSubdivision::create() {
    auto program = makeProgram(std::array<std::string_view, 1>{"subdivide.comp"});
    if (!program) return tl::unexpected(program.error());
    ComputeSubdivision pass;
    pass.mProgram = std::move(*program);
    return pass;
}

void ComputeSubdivision::run(const Texture& visibility, size_t patchCount) {
    // Pieces of more than a few samples, and as many again for each patch.
    const size_t samples = size_t(visibility.width()) * size_t(visibility.height());
    for (Buffer& queue : mQueues)
        queue.reserve(sizeof(QueueHead) + (samples + 16 * patchCount) * sizeof(GpuPiece));
    std::vector<GpuPiece> whole;
    for (uint32_t p = 0; p < patchCount; ++p) whole.push_back({p, 0});
    constexpr QueueHead kEmpty;
    const QueueHead head{{uint32_t((patchCount + kGroupSize - 1) / kGroupSize), 1, 1}, uint32_t(patchCount)};
    mQueues[0].write(0, &head, sizeof(head));
    mQueues[0].write(sizeof(head), whole.data(), whole.size() * sizeof(GpuPiece));

    glUseProgram(mProgram.name());
    glBindImageTexture(0, visibility.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RG32UI);
    for (int depth = 0; depth < kDepths; ++depth) {
        const Buffer& queue = mQueues[size_t(depth % 2)];
        Buffer& next = mQueues[size_t((depth + 1) % 2)];
        next.write(0, &kEmpty, sizeof(kEmpty));
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, queue.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, next.name());
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, queue.name());
        glDispatchComputeIndirect(0);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                        GL_BUFFER_UPDATE_BARRIER_BIT);
    }
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    glBindImageTexture(0, 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32UI);
}

}  // namespace tessera::render
