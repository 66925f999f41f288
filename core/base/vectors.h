// The compiler's vectors of numbers, for functions that are built twice (vector_clones.h): operators work
// lane by lane, comparisons make lanes of integers that are all ones where they hold. Where the machine's
// registers are shorter a vector takes some of them, with the same results. To be handed to inlined functions
// alone.
#pragma once

#include <cstddef>

#include "core/base/vector_clones.h"

namespace tessera {

template <class T, size_t kLanes>
using Vector __attribute__((vector_size(kLanes * sizeof(T)))) = T;

// The same as memory has it: anywhere in an array of T.
template <class T, size_t kLanes>
using VectorInMemory __attribute__((vector_size(kLanes * sizeof(T)), aligned(alignof(T)), may_alias)) = T;

template <size_t kLanes, class T>
TESSERA_INLINE auto loadVector(const T* from) {
    return Vector<T, kLanes>(*reinterpret_cast<const VectorInMemory<T, kLanes>*>(from));
}

// `value` is a Vector<T, kLanes>.
template <size_t kLanes, class T, class Value>
TESSERA_INLINE void storeVector(T* to, const Value& value) {
    *reinterpret_cast<VectorInMemory<T, kLanes>*>(to) = value;
}

}  // namespace tessera
