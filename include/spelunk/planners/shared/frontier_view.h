#pragma once

#include <memory>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/credible_map.h"
#include "spelunk/map/frontier_voxels.h"
#include "spelunk/map/volumetric_gain.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners {

/// What planners that go to frontier voxels see of the map.
struct FrontierViewParams {
  double range_m = 4.0;  ///< How far the rays of a gain go.
  map::Credibility credibility;
};

/// The frontier of the credible map (slivers between the sensor's rows are no frontier), and what
/// the sensors would see from a place. Kept from plan to plan, brought up to date by the map's
/// changes.
class FrontierView {
 public:
  FrontierView(const RobotModel& robot, double resolution_m, const FrontierViewParams& params);

  /// Takes up the map of a request. Call before anything else.
  void look(const std::shared_ptr<const map::FrozenMap>& map);

  /// Forgets all maps.
  void forget();

  [[nodiscard]] const map::FrozenMap& credible() const { return *credible_; }
  [[nodiscard]] const std::shared_ptr<const map::FrozenMap>& sharedCredible() const {
    return credible_;
  }
  [[nodiscard]] const map::FrontierVoxels& frontier() const { return frontier_; }
  [[nodiscard]] double range() const { return params_.range_m; }

  /// The distinct voxels on the rays from a place, each ray cut at the first occupied voxel.
  [[nodiscard]] map::VolumetricGain seenFrom(const Eigen::Vector3d& position, double yaw,
                                             const AxisAlignedBox& bounds) const;

  /// Distance from a place to the nearest occupied voxel centre of `map`, at most `limit_m`.
  [[nodiscard]] static double clearanceAt(const map::FrozenMap& map, const Eigen::Vector3d& place,
                                          double limit_m);

 private:
  FrontierViewParams params_;
  map::GainEvaluator evaluator_;
  map::CredibleMap filter_;
  std::shared_ptr<const map::FrozenMap> credible_;
  map::FrontierVoxels frontier_;
};

}  // namespace spelunk::planners
