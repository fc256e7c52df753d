#include "eight_walks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spelunk/common/contract.h"

#ifdef __x86_64__
#include <immintrin.h>

// GCC 12 takes the deliberately undefined operands inside its own intrinsics for mistakes.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#define SPELUNK_WIDE __attribute__((target("avx512f"), always_inline)) inline
#endif

namespace spelunk::evaluation {

#ifdef __x86_64__
namespace {

constexpr std::size_t kLanes = 8;

/// One axis of eight walks, see Axis of a single one.
struct WideAxis {
  __m512d next;
  __m512d spacing;
  __m512d exit;
  __m512i stride;
};

SPELUNK_WIDE WideAxis axisOf(double from, __m512d direction, int size, std::int64_t stride) {
  const __m512d zero = _mm512_setzero_pd();
  const __m512d infinity = _mm512_set1_pd(std::numeric_limits<double>::infinity());
  const __mmask8 is_up = _mm512_cmp_pd_mask(direction, zero, _CMP_GT_OQ);
  const __mmask8 is_level = _mm512_cmp_pd_mask(direction, zero, _CMP_EQ_OQ);
  const double cell = std::floor(from);
  const __m512d to_next =
      _mm512_mask_blend_pd(is_up, _mm512_set1_pd(from - cell), _mm512_set1_pd(cell + 1.0 - from));
  const __m512d to_exit =
      _mm512_mask_blend_pd(is_up, _mm512_set1_pd(from), _mm512_set1_pd(size - from));
  WideAxis axis;
  axis.spacing = _mm512_abs_pd(_mm512_div_pd(_mm512_set1_pd(1.0), direction));
  axis.next = _mm512_mask_mov_pd(_mm512_mul_pd(to_next, axis.spacing), is_level, infinity);
  axis.exit = _mm512_mask_mov_pd(_mm512_mul_pd(to_exit, axis.spacing), is_level, infinity);
  axis.stride =
      _mm512_mask_blend_epi64(is_up, _mm512_set1_epi64(-stride), _mm512_set1_epi64(stride));
  return axis;
}

SPELUNK_WIDE void step(WideAxis& axis, __mmask8 lanes, __m512i& at) {
  at = _mm512_mask_add_epi64(at, lanes, at, axis.stride);
  axis.next = _mm512_mask_add_pd(axis.next, lanes, axis.next, axis.spacing);
}

/// Those lanes whose voxel is clear.
SPELUNK_WIDE __mmask8 clearOf(__m512i at, __mmask8 going, const VoxelGrid& grid) {
  const __m512i words = _mm512_mask_i64gather_epi64(_mm512_setzero_si512(), going,
                                                    _mm512_srli_epi64(at, 6), grid.words(), 8);
  const __m512i bits =
      _mm512_sllv_epi64(_mm512_set1_epi64(1), _mm512_and_si512(at, _mm512_set1_epi64(63)));
  return _mm512_mask_testn_epi64_mask(going, words, bits);
}

/// Lanes may hold the same voxel.
SPELUNK_WIDE std::size_t setAll(__m512i at, __mmask8 lanes, VoxelGrid& grid) {
  alignas(64) std::uint64_t offsets[kLanes];
  _mm512_store_si512(offsets, at);
  std::size_t found = 0;
  for (unsigned rest = lanes; rest != 0; rest &= rest - 1)
    found += grid.set(offsets[__builtin_ctz(rest)]) ? 1 : 0;
  return found;
}

/// Few voxels are clear any more, so that looking comes before setting.
__attribute__((target("avx512f"))) std::size_t markEight(const RayBlock& rays, std::size_t first,
                                                         VoxelGrid& grid) {
  const std::size_t count = std::min(kLanes, rays.count - first);
  auto going = static_cast<__mmask8>((1U << count) - 1);
  const Eigen::Vector3d& from = rays.from;
  const Eigen::Vector3i& size = grid.size();
  const std::int64_t row = size.x();
  WideAxis x = axisOf(from.x(), _mm512_maskz_load_pd(going, &rays.x[first]), size.x(), 1);
  WideAxis y = axisOf(from.y(), _mm512_maskz_load_pd(going, &rays.y[first]), size.y(), row);
  WideAxis z =
      axisOf(from.z(), _mm512_maskz_load_pd(going, &rays.z[first]), size.z(), row * size.y());
  const __m512d exit = _mm512_min_pd(x.exit, _mm512_min_pd(y.exit, z.exit));
  const __m512d limit = _mm512_min_pd(_mm512_maskz_load_pd(going, &rays.length[first]),
                                      _mm512_sub_pd(exit, _mm512_set1_pd(kInside)));
  const Eigen::Vector3i cell = from.array().floor().cast<int>();
  __m512i at = _mm512_set1_epi64(static_cast<std::int64_t>(grid.offsetOf(cell)));
  std::size_t found = 0;
  while (going != 0) {
    const __mmask8 clear = clearOf(at, going, grid);
    if (clear != 0) found += setAll(at, clear, grid);
    const __mmask8 x_before_y = _mm512_cmp_pd_mask(x.next, y.next, _CMP_LT_OQ);
    const __mmask8 x_before_z = _mm512_cmp_pd_mask(x.next, z.next, _CMP_LT_OQ);
    const __mmask8 y_before_z = _mm512_cmp_pd_mask(y.next, z.next, _CMP_LT_OQ);
    const auto in_x = static_cast<__mmask8>(x_before_y & x_before_z);
    const auto in_y = static_cast<__mmask8>(~x_before_y & y_before_z);
    const auto in_z = static_cast<__mmask8>(~(in_x | in_y));
    const __m512d border = _mm512_min_pd(x.next, _mm512_min_pd(y.next, z.next));
    going = _mm512_mask_cmp_pd_mask(going, border, limit, _CMP_LE_OQ);
    step(x, in_x, at);
    step(y, in_y, at);
    step(z, in_z, at);
  }
  return found;
}

}  // namespace

std::size_t markByEights(const RayBlock& rays, VoxelGrid& grid) {
  std::size_t found = 0;
  for (std::size_t first = 0; first < rays.count; first += kLanes)
    found += markEight(rays, first, grid);
  return found;
}

#else

std::size_t markByEights(const RayBlock&, VoxelGrid&) {
  require(false, "markByEights: this processor has no registers of eight lanes");
  return 0;
}

#endif

}  // namespace spelunk::evaluation
