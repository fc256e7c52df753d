#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "spelunk/common/robot_model.h"
#include "spelunk/mission/command.h"
#include "spelunk/mission/mission_params.h"
#include "spelunk/mission/path_execution.h"
#include "spelunk/mission/safe_space.h"
#include "spelunk/navigation/trajectory_timing.h"

namespace spelunk::mission {

/// A path that is to be flown, and the box that has to stay clear along it (full extents, metres).
struct Leg {
  Path path;
  planners::PathKind kind = planners::PathKind::kLocal;
  Eigen::Vector3d box = Eigen::Vector3d::Zero();
  /// Corners are rounded as far as this box, which may be larger, stays free.
  Eigen::Vector3d corner_box = Eigen::Vector3d::Zero();

  Leg() = default;
  Leg(Path along, planners::PathKind path_kind, const Eigen::Vector3d& clear_box)
      : path(std::move(along)), kind(path_kind), box(clear_box), corner_box(clear_box) {}
};

/// The motion that the robot is commanded: the path it is on and its timing, how a new path takes
/// over from it, and whether the robot follows it and its rest is still clear. It decides nothing:
/// it says what is the matter.
class Flight {
 public:
  Flight(const MissionParams& params, const RobotModel& robot, SafeSpace& space)
      : params_(params), robot_(robot), space_(space) {}

  /// The path the robot is on, none while it holds.
  [[nodiscard]] const std::optional<PathExecution>& active() const { return active_; }
  [[nodiscard]] bool goesHome() const;
  /// The rest of the active path, from where the robot is to be now.
  [[nodiscard]] Path rest(double now_s) const;
  [[nodiscard]] double restTime(double now_s) const;  ///< Seconds; 0 while it holds.

  /// Begins a leg with the motion of now, or at rest `here`.
  void fly(const Leg& leg, const Pose& here, double now_s);
  /// Goes back along `back`, which begins here, without turning.
  void goBack(const Path& back, const Pose& here, double now_s);
  /// Stops, whatever was commanded before. What is commanded next makes a robot with legs stand.
  void stop(Posture posture = Posture::kStand);
  [[nodiscard]] Posture posture() const { return posture_; }  ///< Of the newest command.
  /// No path is flown faster from now on: the robot does not know often enough where it is.
  void limitSpeed(double speed_mps) { speed_limit_mps_ = speed_mps; }
  [[nodiscard]] MotionLimits limits() const;
  /// Where a robot is now that was seen in a state some time ago: it has moved on as it was
  /// commanded, or has braked.
  [[nodiscard]] RobotState movedOn(const RobotState& seen, double now_s) const;
  /// The active path is at its end, or is to be replaced from a standstill.
  void drop() { active_.reset(); }
  /// Holds from now on; the time to settle begins anew.
  void holdFrom(double now_s) { hold_since_s_ = now_s; }
  [[nodiscard]] double holdsSince() const { return hold_since_s_; }
  /// Whether the robot has come to rest.
  [[nodiscard]] bool isAtRest(const Eigen::Vector3d& velocity, double now_s) const;

  /// What is flown if `path` takes over from the active one at `takes_over_s`; from `here` if the
  /// robot holds.
  [[nodiscard]] Path joined(const Path& path, double takes_over_s, const Pose& here,
                            double now_s) const;

  /// How far the robot has left its path, metres; none if it follows it. A robot with legs may fall
  /// behind its timing but not leave its line.
  [[nodiscard]] std::optional<double> gapOffPath(const Pose& here, double now_s) const;
  /// The rest of the line from where a robot with legs really is, to be timed anew; none if it is
  /// in time, or was timed anew just before.
  [[nodiscard]] std::optional<Leg> lateRest(const Pose& here, double now_s);
  /// Whether the robot is at the end of its path.
  [[nodiscard]] bool hasArrived(const Pose& here, double now_s) const;
  /// Whether the path is over in time, and for some seconds more, without the robot at its end.
  [[nodiscard]] bool isOverdue(const Pose& here, double now_s) const;
  /// Whether the robot was not `seen` to move at all since it was last sent off from a standstill,
  /// though it should have: nobody carries out what is commanded.
  [[nodiscard]] bool isIgnored(const Pose& seen, const Pose& here, double now_s) const;
  void noteOccupied(const std::vector<map::VoxelIndex>& voxels, double now_s);
  /// Metres to something new on the path before which the robot has to stop now; none if there is
  /// no such thing.
  [[nodiscard]] std::optional<double> findObstacleAhead(double now_s);

  /// The newest command, once.
  [[nodiscard]] std::optional<Command> takeCommand();
  /// The rest of what is commanded, from now on.
  [[nodiscard]] Command commandAgain(double now_s) const;

 private:
  [[nodiscard]] Command ofBase(Command command) const;
  [[nodiscard]] bool isLate(const Pose& here, double now_s) const;
  [[nodiscard]] double nearestArc(const Pose& here, double now_s) const;
  [[nodiscard]] Trajectory smoothest(const Path& path, const navigation::MotionStart& start,
                                     const Eigen::Vector3d& box);

  const MissionParams& params_;
  const RobotModel& robot_;
  SafeSpace& space_;
  std::optional<PathExecution> active_;
  std::optional<Command> command_;
  Posture posture_ = Posture::kStand;
  double speed_limit_mps_ = std::numeric_limits<double>::infinity();
  double hold_since_s_ = 0.0;
  double next_retime_s_ = 0.0;
  Eigen::Vector3d sent_from_ = Eigen::Vector3d::Zero();  ///< Where it last stood, sent off.
  int retimed_in_place_ = 0;                             ///< Since it last moved.
};

}  // namespace spelunk::mission
