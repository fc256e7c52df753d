#pragma once

/// Before a function of plain loops: the compiler makes a second version for processors with wide
/// registers (AVX2), and the program takes the one that fits when it starts. The results are the
/// same; sources with such loops want -O3 (see `loop_flags` in CMakeLists.txt).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define SPELUNK_WIDE_IF_POSSIBLE __attribute__((target_clones("avx2", "default")))
#else
#define SPELUNK_WIDE_IF_POSSIBLE
#endif

namespace spelunk {

/// Whether this processor has registers of eight doubles (AVX-512), for functions that are written
/// for them by hand.
inline bool hasEightLanes() {
#ifdef __x86_64__
  static const bool has = __builtin_cpu_supports("avx512f") != 0;
  return has;
#else
  return false;
#endif
}

}  // namespace spelunk
