// The buffers that all passes share; a pass that writes one declares it itself.
layout(std430, binding = 0) readonly buffer EdgeBuffer { Edge edges[]; };
layout(std430, binding = 1) readonly buffer PatchBuffer { Patch patches[]; };
