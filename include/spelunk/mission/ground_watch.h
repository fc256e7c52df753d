#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "spelunk/mission/basis.h"
#include "spelunk/terrain/terrain_map.h"

namespace spelunk::mission {

/// What is the matter with the ground that a robot with legs is about to step on.
struct GroundFinding {
  enum class Kind { kUnseen, kUntraversable };
  Kind kind = Kind::kUnseen;
  std::string why;  ///< One sentence.
  NoGoZone zone;    ///< To be marked for good; only for kUntraversable.
};

/// The ground under a robot with legs: while it walks, what lies ahead is checked again and again
/// (Dang 2020, section 4.3). It finds where the robot has to stop, the zone that is to be marked
/// there, and the way back from it. Robots that fly have none: nothing is ever found.
class GroundWatch {
 public:
  GroundWatch(const Basis& basis, const terrain::TerrainParams& params);

  void assumeGroundHere();
  void noteScan(const Scan& scan);
  /// Looks at the ground ahead, now and then. `trail`: where the robot has walked before.
  [[nodiscard]] std::optional<GroundFinding> look(const Path& trail, double now_s);

  /// Backing off: asked for, done as soon as the robot stands, forgotten with what it was for.
  void askToBackOff() { backs_off_ = true; }
  [[nodiscard]] bool isToBackOff() const { return backs_off_; }
  /// The way back along the trail, beginning here; empty if there is none. It is asked for once.
  [[nodiscard]] Path takeWayBack(const Path& trail);
  /// Forgets what the robot was about to do; what is known of the ground stays.
  void reset();

  /// The ground as it is known; nullptr for robots that fly.
  [[nodiscard]] std::shared_ptr<const terrain::TerrainView> view();

 private:
  [[nodiscard]] Path motionAhead(double length_m, double now_s) const;
  [[nodiscard]] bool wasWalkedOn(const terrain::PathGroundCheck& bad, const Path& trail) const;
  [[nodiscard]] bool isFootOfWall(const terrain::PathGroundCheck& bad) const;
  [[nodiscard]] bool hasWaitedBefore(const Eigen::Vector3d& unseen) const;

  Basis basis_;
  std::optional<terrain::TerrainMap> terrain_;
  double next_check_s_ = 0.0;
  std::optional<Eigen::Vector3d> unseen_place_;  ///< The robot has stood before it to look.
  bool backs_off_ = false;
};

}  // namespace spelunk::mission
