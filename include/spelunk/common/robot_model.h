#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/common/trajectory.h"

namespace spelunk {

/// The tight box's share of the safety box. It is used only where no known way home has room for
/// more: half of the margin is left.
inline constexpr double kTightShare = 0.75;

enum class RobotKind { kAerial, kLegged };

/// The body's share of the safety box: half of it is margin, on both sides together. Returns from
/// the body are never obstacles.
inline constexpr double kBodyShare = 0.5;

/// A robot as planner, mission and simulator know it (config/robots/*.yaml, section "robot").
struct RobotModel {
  std::string name = "aerial";
  std::string kind = "aerial";           ///< "aerial" or "legged"
  Eigen::Vector3d box_m{1.1, 1.1, 0.4};  ///< Full extents; axis-aligned.
  double box_lift_m = 0.0;               ///< Centre of the box above the base.
  double ride_height_m = 0.0;            ///< Base above the ground; legged only.
  double slope_max_deg = 20.0;           ///< Of ground it can walk on; legged only.
  double step_max_m = 0.2;               ///< Up or down; legged only.
  double speed_max_mps = 2.0;
  double acceleration_max_mps2 = 2.0;
  double yaw_rate_max_radps = 1.2;
  double yaw_acceleration_max_radps2 = 3.0;
  double braking_deceleration_mps2 = 2.5;        ///< What an emergency stop reaches for sure.
  double reaction_time_s = 0.3;                  ///< From a new obstacle seen to braking.
  double take_off_height_m = 1.0;                ///< Above where it stood; aerial only.
  double stand_up_s = 4.0;                       ///< From lying to standing; legged only.
  double tilt_room_m = 0.0;                      ///< Above and below its box; see narrowSpeed().
  double endurance_s = 900.0;                    ///< On a full battery, at cruising speed.
  std::vector<std::string> sensors{"lidar_16"};  ///< Names in config/sensors or paths.
  std::vector<SensorModel> sensor_models;        ///< Filled by loadRobot.
  std::vector<std::string> self_filter_boxes_m;  ///< Base frame; see selfFilterBoxes().

  template <class Visitor>
  void visit(Visitor&& field) {
    field("kind", kind, Bounds{}, "aerial or legged");
    field("box_m", box_m, Bounds{0.05, 10.0}, "length, width, height, safety margin included",
          Audience::kUser);
    field("box_lift_m", box_lift_m, Bounds{-2.0, 2.0}, "centre of the box above the base");
    field("ride_height_m", ride_height_m, Bounds{0.0, 3.0}, "base above the ground (legged)");
    field("slope_max_deg", slope_max_deg, Bounds{1.0, 60.0}, "ground it can walk on (legged)");
    field("step_max_m", step_max_m, Bounds{0.0, 1.0}, "step it can take (legged)");
    field("speed_max_mps", speed_max_mps, Bounds{0.05, 20.0}, "cruising speed", Audience::kUser);
    field("acceleration_max_mps2", acceleration_max_mps2, Bounds{0.1, 20.0},
          "acceleration of planned motion");
    field("yaw_rate_max_radps", yaw_rate_max_radps, Bounds{0.05, 10.0}, "turning speed");
    field("yaw_acceleration_max_radps2", yaw_acceleration_max_radps2, Bounds{0.1, 50.0},
          "turning acceleration");
    field("braking_deceleration_mps2", braking_deceleration_mps2, Bounds{0.1, 30.0},
          "sure deceleration of a stop");
    field("reaction_time_s", reaction_time_s, Bounds{0.0, 5.0}, "from seeing to braking");
    field("take_off_height_m", take_off_height_m, Bounds{0.1, 20.0},
          "climbs so high above where it stood before it flies on (aerial)");
    field("stand_up_s", stand_up_s, Bounds{0.0, 60.0},
          "waits so long for its legs to lift it before it walks (legged)");
    field(
        "tilt_room_m", tilt_room_m, Bounds{0.0, 2.0},
        "a body that tilts to start and stop needs so much above and below the box at full speed");
    field("endurance_s", endurance_s, Bounds{1.0, 1e6},
          "how long a full battery lasts at cruising speed", Audience::kUser);
    field("sensors", sensors, Bounds{}, "names from config/sensors or paths of files",
          Audience::kUser);
    field("self_filter_boxes_m", self_filter_boxes_m, Bounds{},
          "returns from its own parts: boxes in the base frame, each centre x, y, z, size x, y, z",
          Audience::kUser);
  }
  [[nodiscard]] std::vector<std::string> problems() const;
};

[[nodiscard]] RobotKind kindOf(const RobotModel& robot);

/// How far the farthest-seeing sensor reaches, metres; 0 without sensors.
[[nodiscard]] double longestRange(const RobotModel& robot);
/// Up to which distance the rows of its best sensor are no farther apart than its box is high, so
/// that a place there is known as a whole, metres; 0 without sensors.
[[nodiscard]] double denseRange(const RobotModel& robot);
/// The longest range of the rays of gains of its sensors, metres; 0 without sensors.
[[nodiscard]] double longestGainRange(const RobotModel& robot);
/// What one look of the sensor that sees most shows, m3; 0 without sensors.
[[nodiscard]] double lookVolume(const RobotModel& robot);
/// Whether a sensor of it looks all round, so that its heading does not matter.
[[nodiscard]] bool seesAllAround(const RobotModel& robot);
/// How far from its start a robot gets that is home again after `time_limit_s` or at the end of its
/// endurance, and how far it sees from there, metres.
[[nodiscard]] double reachOf(const RobotModel& robot, double time_limit_s);
[[nodiscard]] MotionLimits limitsOf(const RobotModel& robot);

/// Distance to a standstill from `speed_mps`, reaction time included.
[[nodiscard]] double brakingDistance(const RobotModel& robot, double speed_mps);

/// How fast a robot moves where its box has lost its margin (see kTightShare) or its body has no
/// room to tilt: it comes to rest within the margin that is left, m/s.
[[nodiscard]] double narrowSpeed(const RobotModel& robot);

/// Reads "robot.*" and each of its sensors ("sensor.<name>.*") from `tree`; sensor files lie below
/// values already in the tree. A sensor is a name from `config_dir`/sensors or, where that has no
/// such file, from `folders`, or the path of a file seen from `folders`, whose stem is its name.
/// Problems are added to the tree. Throws OutsideError if a sensor's file is missing.
[[nodiscard]] RobotModel loadRobot(ParamTree& tree, const std::string& name,
                                   const std::string& config_dir,
                                   const std::vector<std::string>& folders = {""});

}  // namespace spelunk
