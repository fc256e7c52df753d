#pragma once

#include <Eigen/Core>
#include <vector>

#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners {

/// A target and what it promised when it was chosen.
struct Visit {
  Eigen::Vector3d voxel = Eigen::Vector3d::Zero();  ///< The frontier voxel it was chosen for.
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  double gain_m3 = 0.0;
  double chosen_s = 0.0;  ///< Mission time.
};

/// Whether the robot has been within `radius_m` of a place; never for a radius of 0.
[[nodiscard]] bool wasVisited(const std::vector<StampedPose>& trail, const Eigen::Vector3d& place,
                              double radius_m);

/// Targets that are flown to. A plan often begins before the robot has come to the end of the last
/// one; what a target was worth can only be told when the robot has been there.
class Visits {
 public:
  void expect(const Visit& visit);

  /// The targets the robot has come by since they were chosen; they are expected no longer. Told by
  /// the trail and, as a robot that moves to and fro leaves none, by where earlier plans began.
  /// `last`: what became of the path that was reported last.
  [[nodiscard]] std::vector<Visit> takeMade(const PlanRequest& request, PathOutcome last);

 private:
  void noteStart(const PlanRequest& request, PathOutcome last);
  [[nodiscard]] bool isMade(const Visit& visit, const PlanRequest& request, PathOutcome last) const;

  std::vector<Visit> expected_;
  std::vector<StampedPose> starts_;  ///< Of the latest plans, oldest first.
};

}  // namespace spelunk::planners
