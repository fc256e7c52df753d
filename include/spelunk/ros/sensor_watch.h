#pragma once

#include <string>
#include <vector>

#include "spelunk/common/robot_model.h"

namespace spelunk::bridge {

/// Notices sensors of a robot that send nothing while others do: the mission goes on without them,
/// but it must be said what that costs. Sensors are told by the frame of their clouds; a robot none
/// of whose frames bears a sensor's name is not watched. Mission time. Not thread-safe.
class SensorWatch {
 public:
  /// A sensor is missing if it has been silent for longer than `silence_s`.
  SensorWatch(const RobotModel& robot, double silence_s);

  void heard(const std::string& frame, double now_s);

  /// One text for each sensor that has gone missing, or come back, since the last call.
  [[nodiscard]] std::vector<std::string> news(double now_s);

 private:
  struct Watched {
    std::string name;
    SensorKind kind = SensorKind::kLidar;
    double heard_s = 0.0;
    bool is_missing = false;
  };
  std::vector<Watched> sensors_;
  double silence_s_;
  bool has_begun_ = false;
};

}  // namespace spelunk::bridge
