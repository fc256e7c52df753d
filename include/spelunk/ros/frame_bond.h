#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace spelunk::bridge {

/// How a cloud's frame hangs together with the robot.
enum class FrameBond {
  kCarried,   ///< The robot carries it: the frame's origin is the sensor.
  kFixed,     ///< It stays where it is: its clouds are registered, their rays began elsewhere.
  kUndecided  ///< The robot has not moved enough to tell.
};

/// Tells frames that a robot carries from frames that stay in the world: by the tree of transforms
/// where that decides it, else by what moves when the robot moves. Not thread-safe.
class FrameBonds {
 public:
  /// The frame above another one in tf; none at the root and for unknown frames.
  using ParentLookup = std::function<std::optional<std::string>(const std::string& frame)>;

  /// `reach_m`: no sensor is mounted farther from the base. `motion_m`: a base that moved so far
  /// has moved (must exceed the noise of odometry).
  FrameBonds(const std::string& world_frame, double reach_m, double motion_m, ParentLookup parent);

  /// The frames of odometry: the one its poses are in, and that of the base (may be empty).
  void noteOdometry(const std::string& frame, const std::string& base_frame);

  /// Bond of `frame`, which is now at `T_world_frame` while the base is at `T_world_base`.
  [[nodiscard]] FrameBond bondOf(const std::string& frame, const Eigen::Isometry3d& T_world_frame,
                                 const Eigen::Isometry3d& T_world_base);

  void forget() { seen_.clear(); }

 private:
  struct Seen {
    Eigen::Isometry3d T_world_frame;
    Eigen::Isometry3d T_world_base;
    FrameBond bond = FrameBond::kUndecided;
  };
  [[nodiscard]] FrameBond bondByTree(const std::string& frame) const;
  [[nodiscard]] FrameBond bondByMotion(const std::string& frame,
                                       const Eigen::Isometry3d& T_world_frame,
                                       const Eigen::Isometry3d& T_world_base);

  std::string world_frame_;
  double reach_m_;
  double motion_m_;
  ParentLookup parent_;
  std::string odometry_frame_;
  std::string base_frame_;
  std::map<std::string, Seen> seen_;  ///< By frame: where both were at the last decision.
};

}  // namespace spelunk::bridge
