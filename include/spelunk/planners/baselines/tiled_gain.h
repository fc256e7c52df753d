#pragma once

#include <map>
#include <memory>
#include <utility>

#include "spelunk/common/box.h"
#include "spelunk/common/pose.h"
#include "spelunk/map/kept_window.h"
#include "spelunk/map/volumetric_gain.h"

namespace spelunk::planners::baselines {

/// Gains anywhere in a whole map, for many places in no order. They are read from one window round
/// all that is known, which is kept between plans, or, if it would be too large, from copies of the
/// tiles that places fall into. Lives for one plan; refers to its arguments.
class TiledGain {
 public:
  /// `cells_max`: of the one window.
  TiledGain(std::shared_ptr<const map::FrozenMap> map, const map::GainEvaluator& evaluator,
            const AxisAlignedBox& bounds, map::KeptWindow& window,
            double cells_max = kWindowCellsMax);

  /// Unknown volume that the sensors would see from a pose; m3. Rays may run into unknown space
  /// sideways as far as they reach, upwards one voxel beyond all that is known.
  [[nodiscard]] double visibleFrom(const Pose& pose);

  [[nodiscard]] std::size_t tiles() const { return windows_.size(); }  ///< Copied so far.

 private:
  using Tile = std::pair<int, int>;
  [[nodiscard]] const map::LocalWindow& windowAround(const Eigen::Vector3d& position);

  static constexpr double kWindowCellsMax = 4e8;

  std::shared_ptr<const map::FrozenMap> map_;
  const map::GainEvaluator& evaluator_;
  const AxisAlignedBox& bounds_;
  const map::LocalWindow* whole_ = nullptr;
  AxisAlignedBox region_;  ///< Of the one window: rays end there.
  double side_m_;
  double margin_m_;
  std::map<Tile, map::LocalWindow> windows_;
};

}  // namespace spelunk::planners::baselines
