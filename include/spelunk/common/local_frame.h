#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>

#include "spelunk/common/moved.h"

namespace spelunk {

/// The frame in which the core works: parallel to the caller's frame (`world`), its origin near the
/// first pose. Maps have keys for some kilometres around their origin only, and 32-bit numbers have
/// no millimetres far from it; so whatever reads and writes the caller's messages and files (UTM, a
/// mine's grid, ECEF) converts there, and nothing behind it knows of it. Where somebody's SLAM
/// corrects the caller's frame, this one stays with the robot and its map: it is shifted against
/// the caller's, and may be turned about z.
class LocalFrame {
 public:
  LocalFrame() = default;  ///< The caller's own frame.
  explicit LocalFrame(const Eigen::Vector3d& origin) : T_caller_local_(origin) {}
  explicit LocalFrame(const Shift& T_caller_local) : T_caller_local_(T_caller_local) {}

  /// The frame for a robot that is first met at `first` (caller's frame) and may get `reach_m` away
  /// from it: the caller's own, if coordinates of all that lies within reach stay below `range_m`
  /// (of the map's keys) and below kExact_m; else with its origin at the whole hundreds of metres
  /// nearest to `first`, which people can read and which leaves every decimal as it is.
  [[nodiscard]] static LocalFrame around(const Eigen::Vector3d& first, double reach_m,
                                         double range_m);

  /// Up to here neighbouring 32-bit numbers lie half a millimetre apart at most.
  static constexpr double kExact_m = 8192.0;

  /// This frame after the caller's was corrected: what was at p is at `correction(p)` now.
  [[nodiscard]] LocalFrame corrected(const Shift& correction) const;

  [[nodiscard]] const Shift& T_caller_local() const { return T_caller_local_; }
  /// Caller's frame.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return T_caller_local_.by; }
  [[nodiscard]] double yaw() const { return T_caller_local_.yaw_rad; }  ///< In the caller's frame.
  [[nodiscard]] bool isCallers() const { return origin().isZero(0.0) && yaw() == 0.0; }
  [[nodiscard]] bool operator==(const LocalFrame& other) const {
    return origin() == other.origin() && yaw() == other.yaw();
  }
  [[nodiscard]] bool operator!=(const LocalFrame& other) const { return !(*this == other); }

  /// From the caller's frame into this one, of all that moved() knows.
  template <class T>
  [[nodiscard]] T toLocal(T thing) const {
    return isCallers() ? thing : moved(std::move(thing), T_caller_local_.inverse());
  }
  /// A place that a person wrote down, to the micrometre: 467002.3 m with an origin at 467000 m is
  /// 2.3 m, not the 2.2999999999884 m that are left of it in double precision.
  [[nodiscard]] Pose written(const Pose& pose) const;
  [[nodiscard]] Eigen::Vector3d written(const Eigen::Vector3d& point) const;
  /// From this frame into the caller's.
  template <class T>
  [[nodiscard]] T toCaller(T thing) const {
    return isCallers() ? thing : moved(std::move(thing), T_caller_local_);
  }

 private:
  Shift T_caller_local_;
};

/// What people are told of a frame that is not their own; empty for one that is.
[[nodiscard]] std::string sayingOf(const LocalFrame& frame);

}  // namespace spelunk
