// The memory of the process.
#pragma once

namespace tessera {

// Gives memory that has been freed back to the system where the allocator keeps it otherwise: after work that
// held a lot in many small parts. Takes some milliseconds a gigabyte.
void releaseFreeMemory();

}  // namespace tessera
