#pragma once

#include <string>
#include <vector>

#include "spelunk/mission/mission.h"
#include "spelunk/sim/mesh_scene.h"

namespace spelunk::evaluation {

/// What was seen of the promise that a robot comes home and touches nothing.
struct PromiseRecord {
  double unsure_s = 0.0;            ///< So long the mission said that no way home is sure.
  std::string unsure_why;           ///< What it said first.
  int broken_ticks = 0;             ///< Looks at which something promised did not hold.
  std::vector<std::string> faults;  ///< What that was; each kind once.
};

/// Looks at every tick of a mission whether the promise of its design holds: a way home is known
/// from about where the robot is to home, its pessimistic time fits the remaining endurance, and it
/// is free in the true mesh; where that cannot be, the mission says so. A path along which less
/// than the safety box is clear is flown slowly where the margin is gone. It relies on nothing but
/// what the mission shows.
class PromiseWatch {
 public:
  /// `body_m`: full extents of the robot's true body. Both must outlive it.
  PromiseWatch(const mission::Mission& mission, const sim::MeshScene& scene,
               const Eigen::Vector3d& body_m)
      : mission_(mission), scene_(scene), body_m_(body_m) {}

  /// Whether the mission's poses are those of the mesh: where odometry drifts the mesh says nothing
  /// about paths.
  enum class Paths { kComparable, kUnknownInTruth };
  /// To be called after a tick. `pose`: of the robot's base as odometry has it, in the mission's
  /// frame; `true_speed_mps`: of the body.
  void look(double now_s, const Pose& pose, double true_speed_mps, Paths paths);

  [[nodiscard]] const PromiseRecord& record() const { return record_; }

 private:
  void lookAtWayHome(double now_s, const mission::MissionStatus& status, const Pose& pose);
  void lookAtTruth(double now_s, const Path& way);
  void lookAtSpeed(double now_s, const mission::MissionStatus& status, const Pose& pose,
                   double speed_mps);
  void note(double now_s, const std::string& what);

  const mission::Mission& mission_;
  const sim::MeshScene& scene_;
  Eigen::Vector3d body_m_;
  double last_s_ = 0.0;
  bool is_broken_ = false;  ///< At the present look.
  PromiseRecord record_;
};

}  // namespace spelunk::evaluation
