#include "wide_walks.h"

#include <algorithm>
#include <limits>

#include "spelunk/common/contract.h"

#ifdef __x86_64__
#include <immintrin.h>

// GCC 12 takes the deliberately undefined operands inside its own intrinsics for mistakes.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#define SPELUNK_WIDE __attribute__((target("avx512f"), always_inline)) inline
#endif

namespace spelunk::map {

#ifdef __x86_64__
namespace {

constexpr std::size_t kLanes = 8;

struct alignas(64) Doubles {
  double of[kLanes];
};
struct alignas(64) Integers {
  std::int64_t of[kLanes];
};

/// Eight walks as numbers beside each other; behind the last one its copies.
struct EightWalks {
  Doubles next[3];
  Doubles spacing[3];
  Doubles length;
  Integers step[3];
  Integers start;
  Integers end;

  EightWalks(const RayWalk* walks, std::size_t count, const RayGrid& grid) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const RayWalk& walk = walks[std::min(k, count - 1)];
      for (int axis = 0; axis < 3; ++axis) {
        next[axis].of[k] = walk.next[axis];
        spacing[axis].of[k] = walk.spacing[axis];
        step[axis].of[k] = walk.step[axis] * grid.stride(axis);
      }
      length.of[k] = walk.length;
      start.of[k] = grid.offsetOf(walk.start);
      end.of[k] = grid.offsetOf(walk.end);
    }
  }
};

/// Sets the bits at the places of those lanes that are still going.
SPELUNK_WIDE void markPlaces(__m512i at, unsigned going, std::uint64_t* words) {
  Integers word;
  Integers bit;
  const __m512i in_word = _mm512_and_si512(at, _mm512_set1_epi64(63));
  _mm512_store_si512(word.of, _mm512_srli_epi64(at, 6));
  _mm512_store_si512(bit.of, _mm512_sllv_epi64(_mm512_set1_epi64(1), in_word));
  if (going == 0xFF)
    for (std::size_t k = 0; k < kLanes; ++k)
      words[word.of[k]] |= static_cast<std::uint64_t>(bit.of[k]);
  else
    for (; going != 0; going &= going - 1) {
      const int k = __builtin_ctz(going);
      words[word.of[k]] |= static_cast<std::uint64_t>(bit.of[k]);
    }
}

__attribute__((target("avx512f"))) void walkThroughEight(const EightWalks& walks, unsigned going,
                                                         std::uint64_t* words) {
  __m512d next_x = _mm512_load_pd(walks.next[0].of);
  __m512d next_y = _mm512_load_pd(walks.next[1].of);
  __m512d next_z = _mm512_load_pd(walks.next[2].of);
  const __m512d spacing_x = _mm512_load_pd(walks.spacing[0].of);
  const __m512d spacing_y = _mm512_load_pd(walks.spacing[1].of);
  const __m512d spacing_z = _mm512_load_pd(walks.spacing[2].of);
  const __m512i step_x = _mm512_load_si512(walks.step[0].of);
  const __m512i step_y = _mm512_load_si512(walks.step[1].of);
  const __m512i step_z = _mm512_load_si512(walks.step[2].of);
  const __m512i end = _mm512_load_si512(walks.end.of);
  __m512i at = _mm512_load_si512(walks.start.of);
  __m512d limit = _mm512_set1_pd(std::numeric_limits<double>::infinity());
  while (going != 0) {
    const __mmask8 x_before_y = _mm512_cmp_pd_mask(next_x, next_y, _CMP_LT_OQ);
    const __mmask8 x_before_z = _mm512_cmp_pd_mask(next_x, next_z, _CMP_LT_OQ);
    const __mmask8 y_before_z = _mm512_cmp_pd_mask(next_y, next_z, _CMP_LT_OQ);
    const auto in_x = static_cast<__mmask8>(x_before_y & x_before_z);
    const auto in_y = static_cast<__mmask8>(~x_before_y & y_before_z);
    const auto in_z = static_cast<__mmask8>(~(in_x | in_y));
    const __m512d border = _mm512_min_pd(next_x, _mm512_min_pd(next_y, next_z));
    going &= ~static_cast<unsigned>(_mm512_cmp_pd_mask(border, limit, _CMP_GT_OQ));
    markPlaces(at, going, words);
    at = _mm512_mask_add_epi64(at, in_x, at, step_x);
    at = _mm512_mask_add_epi64(at, in_y, at, step_y);
    at = _mm512_mask_add_epi64(at, in_z, at, step_z);
    next_x = _mm512_mask_add_pd(next_x, in_x, next_x, spacing_x);
    next_y = _mm512_mask_add_pd(next_y, in_y, next_y, spacing_y);
    next_z = _mm512_mask_add_pd(next_z, in_z, next_z, spacing_z);
    limit = _mm512_load_pd(walks.length.of);
    going &= _mm512_cmpneq_epi64_mask(at, end);
  }
}

}  // namespace

bool hasEightLanes() {
  static const bool has = __builtin_cpu_supports("avx512f") != 0;
  return has;
}

void walkThroughByEights(const std::vector<RayWalk>& walks, const RayGrid& grid,
                         std::uint64_t* words) {
  for (std::size_t first = 0; first < walks.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, walks.size() - first);
    walkThroughEight(EightWalks(&walks[first], count, grid), (1U << count) - 1, words);
  }
}

#else

bool hasEightLanes() { return false; }

void walkThroughByEights(const std::vector<RayWalk>&, const RayGrid&, std::uint64_t*) {
  require(false, "walkThroughByEights: this processor has no registers of eight lanes");
}

#endif

}  // namespace spelunk::map
