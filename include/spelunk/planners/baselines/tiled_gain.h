#pragma once

#include <map>
#include <utility>

#include "spelunk/common/box.h"
#include "spelunk/common/pose.h"
#include "spelunk/map/local_window.h"
#include "spelunk/map/volumetric_gain.h"

namespace spelunk::planners::baselines {

/// Gains anywhere in a whole map, for many places in no order: the map is copied tile by tile where
/// a place falls, not once a place. Lives for one plan; refers to its arguments.
class TiledGain {
 public:
  TiledGain(const map::FrozenMap& map, const map::GainEvaluator& evaluator,
            const AxisAlignedBox& bounds);

  /// Unknown volume that the sensors would see from a pose; m3. Rays may run into unknown space
  /// sideways as far as they reach, upwards one voxel beyond all that is known.
  [[nodiscard]] double visibleFrom(const Pose& pose);

  [[nodiscard]] std::size_t tiles() const { return windows_.size(); }  ///< Copied so far.

 private:
  using Tile = std::pair<int, int>;
  [[nodiscard]] const map::LocalWindow& windowAround(const Eigen::Vector3d& position);

  const map::FrozenMap& map_;
  const map::GainEvaluator& evaluator_;
  const AxisAlignedBox& bounds_;
  double side_m_;
  double margin_m_;
  std::map<Tile, map::LocalWindow> windows_;
};

}  // namespace spelunk::planners::baselines
