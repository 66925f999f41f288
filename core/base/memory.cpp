// See memory.h.
#include "core/base/memory.h"

#include <cstdlib>  // defines __GLIBC__ where it is the library

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace tessera {

void releaseFreeMemory() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

}  // namespace tessera
