// A function that the compiler builds twice, with AVX2 and without, of which the machine takes one. Both do
// the same arithmetic (no fused operations: -ffp-contract=off), so that results do not depend on the machine.
#pragma once

// The choice is made before the thread sanitizer has started, which would end the program; its build has one.
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
#define TESSERA_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define TESSERA_VECTOR_CLONES
#endif

// What such a function calls has to become part of it: no vector may cross a call.
#define TESSERA_INLINE inline __attribute__((always_inline))
