#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "spelunk/common/self_filter.h"
#include "spelunk/common/self_return_watch.h"

namespace spelunk {

/// A robot's own parts in the scans of its sensors: takes out those that its description names and
/// notices the others. Not thread-safe.
class SelfReturns {
 public:
  /// `range_min_m`: the map's; nearer returns are dropped there.
  SelfReturns(const RobotModel& robot, double range_min_m)
      : robot_(robot), range_min_m_(range_min_m), filter_(robot) {}

  /// The points of a scan (sensor frame) without the robot's known own parts. `sensor` tells the
  /// robot's sensors apart.
  [[nodiscard]] std::vector<Eigen::Vector3f> without(const std::string& sensor,
                                                     std::vector<Eigen::Vector3f> points,
                                                     const Eigen::Isometry3d& T_base_sensor,
                                                     const Eigen::Isometry3d& T_world_base);

  /// As SelfReturnWatch has them; of the first sensor by name that has one, which is named.
  [[nodiscard]] std::string finding() const { return firstOf(&SelfReturnWatch::finding); }
  [[nodiscard]] std::string doubt() const { return firstOf(&SelfReturnWatch::doubt); }

  void forget() { watches_.clear(); }

 private:
  [[nodiscard]] std::string firstOf(const std::string& (SelfReturnWatch::*text)() const) const;

  RobotModel robot_;
  double range_min_m_;
  SelfFilter filter_;
  std::map<std::string, SelfReturnWatch> watches_;  ///< By sensor.
};

}  // namespace spelunk
