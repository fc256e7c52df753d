#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/shared/free_space.h"

namespace spelunk::planners {

/// Where a search may begin, or why it may not.
struct StartCheck {
  std::optional<Eigen::Vector3d> root;
  PlanStatus refusal = PlanStatus::kOk;  ///< Only meaningful without a root.
  std::string reason;
};

/// The requested position if the robot's box is free there; else the nearest free position within
/// 0.6 m of it (a voxel of noise may touch the box of a robot that flies well). A start outside the
/// bounds or inside a zone is refused as kOutOfBounds, one without free place near as
/// kStartBlocked.
[[nodiscard]] StartCheck checkStart(const PlanRequest& request, const FreeSpace& space);

/// The result of a plan that cannot begin.
[[nodiscard]] PlanResult refusedStart(const StartCheck& start);

}  // namespace spelunk::planners
