#pragma once

#include <memory>
#include <optional>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/inflated_window.h"
#include "spelunk/map/local_window.h"
#include "spelunk/map/volumetric_gain.h"
#include "spelunk/navigation/swept_path_check.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/gbplanner/gb_planner_params.h"
#include "spelunk/planners/shared/free_space.h"

namespace spelunk::planners::gbplanner {

/// The map around one place as one plan needs it: where the robot may be, and what it would gain.
/// Refers to the request, the robot and the evaluator, which must outlive it.
class PlanView {
 public:
  /// `box_m`: full extents of the local box.
  PlanView(const PlanRequest& request, const RobotModel& robot, const GbPlannerParams& params,
           const map::GainEvaluator& evaluator, const Eigen::Vector3d& box_m);
  PlanView(const PlanView&) = delete;  // its free spaces refer to its windows
  PlanView& operator=(const PlanView&) = delete;

  [[nodiscard]] const AxisAlignedBox& localBox() const { return local_box_; }
  /// The map in and a little around the local box.
  [[nodiscard]] const map::LocalWindow& window() const { return window_; }
  /// The local box; positions outside it are unknown.
  [[nodiscard]] const FreeSpace& localSpace() const { return local_space_; }
  /// The whole map, slower.
  [[nodiscard]] const FreeSpace& globalSpace() const { return global_space_; }
  /// Makes what only a search needs; call once before roomySpace() and gainAt().
  void prepareSearch(const map::FrozenMap& credible);
  /// The local box with the safety margin around the robot: where it would rather be.
  [[nodiscard]] const FreeSpace& roomySpace() const { return roomy_space_; }
  /// VolumetricGain at a position of the local box, over credible unknown voxels only; none where
  /// the robot has been; m3.
  [[nodiscard]] double gainAt(const Eigen::Vector3d& position, double yaw) const;

 private:
  template <class Map>
  [[nodiscard]] std::optional<GroundUnder> groundIn(const Map& map) const;

  const PlanRequest& request_;
  const RobotModel& robot_;
  const GbPlannerParams& params_;
  const map::GainEvaluator& evaluator_;
  AxisAlignedBox local_box_;
  map::LocalWindow window_;
  std::optional<map::LocalWindow> credible_;
  map::InflatedWindow inflated_;
  std::optional<map::InflatedWindow> inflated_roomy_;
  std::unique_ptr<navigation::SegmentChecker> checker_;
  terrain::GroundRules ground_rules_;
  FreeSpace local_space_;
  FreeSpace roomy_space_;
  FreeSpace global_space_;
};

/// VolumetricGain at any place of the map, with a window of its own; m3.
[[nodiscard]] double gainAnywhere(const PlanRequest& request, const map::FrozenMap& credible,
                                  const map::GainEvaluator& evaluator,
                                  const Eigen::Vector3d& position, double yaw);

}  // namespace spelunk::planners::gbplanner
