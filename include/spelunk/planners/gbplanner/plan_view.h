#pragma once

#include <memory>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/map/kept_window.h"
#include "spelunk/map/volumetric_gain.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/gbplanner/gb_planner_params.h"
#include "spelunk/planners/shared/free_space.h"

namespace spelunk::planners::gbplanner {

/// The robot's box, and the same with the safety margin around it: where it would rather be. Kept
/// by the planner from plan to plan.
struct BodySpaces {
  map::ConfigurationSpace& exact;
  map::ConfigurationSpace& roomy;
};

/// The map as one plan needs it: where the robot may be, and what it would gain. Refers to its
/// arguments, which must outlive it.
class PlanView {
 public:
  /// `window` is kept by the planner from plan to plan, too.
  PlanView(const PlanRequest& request, const RobotModel& robot, const GbPlannerParams& params,
           const map::GainEvaluator& evaluator, const BodySpaces& bodies, map::KeptWindow& window);
  PlanView(const PlanView&) = delete;  // its free spaces refer to what it was made of
  PlanView& operator=(const PlanView&) = delete;

  [[nodiscard]] const AxisAlignedBox& localBox() const { return local_box_; }
  [[nodiscard]] const std::shared_ptr<const map::FrozenMap>& map() const { return request_.map; }
  [[nodiscard]] const FreeSpace& space() const { return space_; }
  [[nodiscard]] const FreeSpace& roomySpace() const { return roomy_space_; }
  /// Makes what gainAt() reads; call once before it.
  void prepareGains(const std::shared_ptr<const map::FrozenMap>& credible);
  /// VolumetricGain at a position of the local box, over credible unknown voxels only; none where
  /// the robot has been; m3.
  [[nodiscard]] double gainAt(const Eigen::Vector3d& position, double yaw) const;

 private:
  const PlanRequest& request_;
  const map::GainEvaluator& evaluator_;
  double visited_radius_m_;
  AxisAlignedBox local_box_;
  map::KeptWindow& window_;
  const map::LocalWindow* credible_ = nullptr;
  AxisAlignedBox gain_bounds_;  ///< Rays end there.
  FreeSpace space_;
  FreeSpace roomy_space_;
};

/// VolumetricGain at any place of the map, with a window of its own; m3.
[[nodiscard]] double gainAnywhere(const PlanRequest& request, const map::FrozenMap& credible,
                                  const map::GainEvaluator& evaluator,
                                  const Eigen::Vector3d& position, double yaw);

}  // namespace spelunk::planners::gbplanner
