#include "spelunk/planners/informed/frontier_sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spelunk::planners::informed {
namespace {

constexpr double kPlaceReach_m = 1.5;  // the box of a large robot ends 0.8 m from its centre
constexpr double kPlaceStep_m = 0.3;
constexpr double kMiddleRate = 4.0;  // of voxels in the middle of a branch against the others

/// Clearances that count as the middle of a branch.
struct Middle {
  float from_m;
  float to_m;
};

Middle middleOf(const std::vector<FrontierVoxel>& frontier) {
  double sum = 0.0;
  float most = 0.0F;
  for (const FrontierVoxel& voxel : frontier) {
    sum += static_cast<double>(voxel.clearance_m);
    most = std::max(most, voxel.clearance_m);
  }
  return {static_cast<float>(sum / static_cast<double>(frontier.size())), most};
}

}  // namespace

bool BarrenVoxels::cover(const Eigen::Vector3d& voxel) const {
  const auto nearest = index_.findNearest(voxel);
  return nearest && (index_.point(*nearest) - voxel).norm() <= kPlaceStep_m;
}

FrontierSampler::FrontierSampler(const map::FrozenMap& map, const KnownSpace& space,
                                 const InformedParams& params, Rng rng, BarrenVoxels& barren,
                                 std::vector<Eigen::Vector3d> apart_from)
    : map_(map),
      space_(space),
      params_(params),
      places_(kPlaceReach_m, kPlaceStep_m),
      rng_(rng),
      barren_(barren),
      chosen_(std::move(apart_from)) {}

/// Weighted order without repetition: the key of an item is an exponential of its rate (Efraimidis
/// and Spirakis, 2006).
std::vector<std::size_t> FrontierSampler::order(const VertexLabel& label, Region region) {
  const Middle middle = middleOf(label.frontier);
  std::vector<std::pair<double, std::size_t>> keys;
  for (std::size_t i = 0; i < label.frontier.size(); ++i) {
    const float clearance = label.frontier[i].clearance_m;
    const bool is_favoured =
        region == Region::kBranch && clearance >= middle.from_m && clearance <= middle.to_m;
    const double rate = is_favoured ? kMiddleRate : 1.0;
    keys.emplace_back(-std::log(1.0 - rng_.uniform()) / rate, i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> indices;
  for (const auto& [key, index] : keys) indices.push_back(index);
  return indices;
}

bool FrontierSampler::isApart(const Eigen::Vector3d& place) const {
  return std::none_of(chosen_.begin(), chosen_.end(), [&](const Eigen::Vector3d& other) {
    return (other - place).norm() < params_.sample_spacing_m;
  });
}

std::vector<FrontierSample> FrontierSampler::draw(graph::VertexId vertex, const VertexLabel& label,
                                                  int count, Region region) {
  std::vector<FrontierSample> samples;
  if (label.frontier.empty()) return samples;
  for (const std::size_t index : order(label, region)) {
    if (static_cast<int>(samples.size()) >= count) break;
    const Eigen::Vector3d voxel = map_.centreOf(label.frontier[index].voxel);
    if (!isApart(voxel)) continue;  // its place would hardly be farther off
    if (barren_.cover(voxel)) continue;
    ++tried_;
    const auto place = places_.findRoomy(voxel, space_);
    if (!place) {
      ++infeasible_;
      barren_.add(voxel);
      continue;
    }
    if (!isApart(*place)) continue;
    chosen_.push_back(*place);
    samples.push_back({vertex, voxel, *place});
  }
  return samples;
}

}  // namespace spelunk::planners::informed
