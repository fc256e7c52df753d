#include "wide_walks.h"

#include <algorithm>
#include <limits>

#include "spelunk/common/contract.h"

#ifdef __x86_64__
#include <immintrin.h>

// GCC 12 takes the deliberately undefined operands inside its own intrinsics for mistakes.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#define SPELUNK_WIDE __attribute__((target("avx512f"), always_inline)) inline
#endif

namespace spelunk::map {

#ifdef __x86_64__
namespace {

constexpr std::size_t kLanes = 8;

struct alignas(64) Integers {
  std::int64_t of[kLanes];
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

SPELUNK_WIDE __m512d doublesAt(const std::vector<double>& values, std::size_t first) {
  return _mm512_loadu_pd(values.data() + first);
}

SPELUNK_WIDE __m512i integersAt(const std::vector<std::int32_t>& values, std::size_t first) {
  return _mm512_cvtepi32_epi64(
      _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values.data() + first)));
}

/// What a number of voxels along an axis adds to an offset in the grid.
SPELUNK_WIDE __m512i offsetsAlong(int axis, __m512i voxels, const RayGrid& grid) {
  return _mm512_mul_epi32(voxels, _mm512_set1_epi64(grid.stride(axis)));
}

SPELUNK_WIDE __m512i endOffsetsAt(const RayWalks& walks, std::size_t first, const RayGrid& grid) {
  __m512i offsets = _mm512_setzero_si512();
  for (int axis = 0; axis < 3; ++axis) {
    const __m512i in_grid =
        _mm512_sub_epi64(integersAt(walks.end[axis], first), _mm512_set1_epi64(grid.first(axis)));
    offsets = _mm512_add_epi64(offsets, offsetsAlong(axis, in_grid, grid));
  }
  return offsets;
}

/// Walks those of the eight walks from `first` on that `going` names.
__attribute__((target("avx512f"))) void walkThroughEight(const RayWalks& walks, std::size_t first,
                                                         unsigned going, const RayGrid& grid,
                                                         std::uint64_t* words) {
  __m512d next_x = doublesAt(walks.next[0], first);
  __m512d next_y = doublesAt(walks.next[1], first);
  __m512d next_z = doublesAt(walks.next[2], first);
  const __m512d spacing_x = doublesAt(walks.spacing[0], first);
  const __m512d spacing_y = doublesAt(walks.spacing[1], first);
  const __m512d spacing_z = doublesAt(walks.spacing[2], first);
  const __m512d length = doublesAt(walks.length, first);
  const __m512i step_x = offsetsAlong(0, integersAt(walks.step[0], first), grid);
  const __m512i step_y = offsetsAlong(1, integersAt(walks.step[1], first), grid);
  const __m512i step_z = offsetsAlong(2, integersAt(walks.step[2], first), grid);
  const __m512i end = endOffsetsAt(walks, first, grid);
  __m512i at = _mm512_set1_epi64(grid.offsetOf(walks.start));
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
    limit = length;
    going &= _mm512_cmpneq_epi64_mask(at, end);
  }
}

}  // namespace

void walkThroughByEights(const RayWalks& walks, const RayGrid& grid, std::uint64_t* words) {
  for (std::size_t first = 0; first < walks.count; first += kLanes) {
    const std::size_t count = std::min(kLanes, walks.count - first);
    walkThroughEight(walks, first, (1U << count) - 1, grid, words);
  }
}

#else

void walkThroughByEights(const RayWalks&, const RayGrid&, std::uint64_t*) {
  require(false, "walkThroughByEights: this processor has no registers of eight lanes");
}

#endif

}  // namespace spelunk::map
