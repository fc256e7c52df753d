#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

enum class MissionState {
  kIdle,
  kTakeOff,
  kExplore,
  kReposition,
  kHome,
  kLand,
  kHold,
  kDone,
  kEStop
};
[[nodiscard]] const char* toText(MissionState state);  ///< "Idle", "Explore", ...

enum class GoToOutcome { kNone, kUnderway, kReached, kUnreachable, kAborted };
[[nodiscard]] const char* toText(GoToOutcome outcome);  ///< "none", "underway", "reached", ...

/// The flight to a point that was asked for. A replan is a new plan because the path in execution
/// cannot be flown on; taking up more of the same path as it comes into view is not counted.
struct GoToStatus {
  GoToOutcome outcome = GoToOutcome::kNone;
  std::string reason;  ///< Of its end; one sentence.
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> nearest_reachable;  ///< Only with kUnreachable, where known.
  int replans_obstacle = 0;   ///< A newly seen obstacle lies on the path, anywhere ahead.
  int replans_deviation = 0;  ///< The robot left the path, or its inputs failed meanwhile.
  int replans_unseen = 0;     ///< What comes next on the path cannot be seen from its known end.
  double planning_s = 0.0;    ///< Wall time of all plans, the first one included.
  double started_s = 0.0;     ///< Mission time.
  double ended_s = 0.0;
};

/// Everything a status line needs.
struct MissionStatus {
  double time_s = 0.0;
  MissionState state = MissionState::kIdle;
  std::string reason;  ///< Of the newest change or refusal, one sentence.
  std::string last_plan_status;
  std::string end_reason;  ///< Why the mission ended; empty before.
  double known_volume_m3 = 0.0;
  double remaining_s = 0.0;
  double way_home_s = 0.0;  ///< Pessimistic.
  double margin_s = 0.0;    ///< remaining - reserve - way home.
  /// Why the promise to come home cannot be kept now (no known way is clear, or none fits what is
  /// left), one sentence; empty while it holds. It does not end the mission: the robot goes on
  /// looking for a way.
  std::string way_home_problem;
  /// Full extents of the box that stays clear along the active path; zero while it holds.
  Eigen::Vector3d clear_box_m = Eigen::Vector3d::Zero();
  double distance_m = 0.0;
  int plans = 0;
  int replans_obstacle = 0;
  int replans_deviation = 0;
  int refused_paths = 0;
  int zones_marked = 0;  ///< No-go zones made around untraversable ground.
  GoToStatus go_to;
  planners::PlanStats last_stats;
  double last_map_update_ms = 0.0;
};

}  // namespace spelunk::mission
