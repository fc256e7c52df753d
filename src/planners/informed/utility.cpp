#include "spelunk/planners/informed/utility.h"

#include <cmath>
#include <limits>

namespace spelunk::planners::informed {

double entropyOf(const map::VolumetricGain& seen, const InformedParams& params) {
  return seen.unknown_voxels + params.entropy_free_bits * seen.free_voxels +
         params.entropy_occupied_bits * seen.occupied_voxels;
}

double entropyAlong(const graph::Polyline& way, const FrontierView& view,
                    const AxisAlignedBox& bounds, const InformedParams& params) {
  const graph::Polyline places = graph::resampled(way, params.range_m);
  double bits = 0.0;
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    bits += entropyOf(view.seenFrom(places[i], 0.0, bounds), params);
  return bits;
}

double logUtility(const UtilityTerms& terms, const InformedParams& params) {
  const double total = params.end_weight * terms.entropy_end_bits +
                       params.way_weight * terms.entropy_way_bits;  // Eq. (3)
  if (!(total > 0.0)) return -std::numeric_limits<double>::infinity();
  const double zeta = terms.region == Region::kBranch ? params.clearance_weight_branch
                                                      : params.clearance_weight_void;
  return std::log(params.gain_factor * total) - params.length_decay * terms.length_m +
         std::log1p(zeta * terms.clearance_m);  // Eq. (4)
}

double worthOf(double gain_m3, double way_m, const InformedParams& params) {
  return gain_m3 / (way_m + params.range_m);
}

}  // namespace spelunk::planners::informed
