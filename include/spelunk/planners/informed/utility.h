#pragma once

#include "spelunk/graph/path_similarity.h"
#include "spelunk/map/volumetric_gain.h"
#include "spelunk/planners/informed/informed_params.h"
#include "spelunk/planners/informed/region_reasoner.h"
#include "spelunk/planners/shared/frontier_view.h"

namespace spelunk::planners::informed {

/// H(q), Akbari 2021, eq. (2), in bits: the binary entropy of the distinct voxels on the rays from
/// a place, each ray cut at the first occupied voxel. An unknown voxel has 1 bit.
/// Differs from paper: planners see the status of a voxel, not its probability, and a known one is
/// soon as sure as the map's limits let it become; what is left then (entropy_free_bits,
/// entropy_occupied_bits) no further look can gain, so by default it counts as nothing.
[[nodiscard]] double entropyOf(const map::VolumetricGain& seen, const InformedParams& params);

/// H(q) at every d_max along a way, its end left out: the second sum of eq. (3).
[[nodiscard]] double entropyAlong(const graph::Polyline& way, const FrontierView& view,
                                  const AxisAlignedBox& bounds, const InformedParams& params);

/// What eq. (4) depends on.
struct UtilityTerms {
  double entropy_end_bits = 0.0;
  double entropy_way_bits = 0.0;
  double length_m = 0.0;     ///< L(Q)
  double clearance_m = 0.0;  ///< D
  Region region = Region::kVoid;
};

/// The natural logarithm of U(c), eq. (4) with H_total of eq. (3): it ranks ways of any length,
/// where U itself would vanish. Minus infinity if there is nothing to gain.
[[nodiscard]] double logUtility(const UtilityTerms& terms, const InformedParams& params);

/// Cubic metres seen for a metre flown, the look from there counted as a way of d_max: what tells a
/// leftover from frontier seen from afar.
[[nodiscard]] double worthOf(double gain_m3, double way_m, const InformedParams& params);

}  // namespace spelunk::planners::informed
