#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "spelunk/common/box.h"

namespace spelunk::sim {

/// Obstacles that appear while the robot is under way. Each is a text:
///   "fall T D": from T seconds on, rock lies where the robot was D metres of its way ago,
///               4 x 4 x 5 m, for good;
///   "person T D": from T seconds on, somebody walks back from there along the robot's way at
///               1.2 m/s and is gone at its start; 0.6 x 0.6 x 1.8 m;
///   "fall T X Y Z SX SY SZ": from T seconds on, rock lies around a place, full extents.
/// Nothing appears within reach of the robot or of its start: the event waits. Rays meet obstacles,
/// a body that touches one is in contact; they do not push it.
class WorldEvents {
 public:
  /// Throws OutsideError with the text and the forms it may have.
  explicit WorldEvents(const std::vector<std::string>& texts = {});

  [[nodiscard]] bool isEmpty() const { return events_.empty(); }
  /// Time goes on; `robot_at`: its true position.
  void update(double time_s, const Eigen::Vector3d& robot_at);
  /// What is there now, world frame.
  [[nodiscard]] const std::vector<AxisAlignedBox>& boxes() const { return boxes_; }
  /// Ends rays at obstacles: unit `directions` from `origin`, one range each.
  void shorten(const Eigen::Vector3f& origin, const std::vector<Eigen::Vector3f>& directions,
               std::vector<float>& ranges) const;
  /// Whether an axis-aligned box (full extents) touches an obstacle.
  [[nodiscard]] bool touches(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) const;

 private:
  struct Event {
    bool walks = false;
    double from_s = 0.0;
    double behind_m = 0.0;
    AxisAlignedBox box;  ///< Around the origin where it is to lie behind the robot.
    bool is_placed = false;
    bool is_there = false;
    double arc_m = 0.0;  ///< Where on the robot's way it is.
  };
  static Event eventFrom(const std::string& text);
  void appear(Event& event, const Eigen::Vector3d& robot_at);
  [[nodiscard]] Eigen::Vector3d placeAt(double arc_m) const;

  std::vector<Event> events_;
  std::vector<Eigen::Vector3d> way_;  ///< Of the robot, evenly spaced.
  std::vector<AxisAlignedBox> boxes_;
  double last_s_ = 0.0;
};

}  // namespace spelunk::sim
