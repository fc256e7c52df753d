#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "spelunk/sim/simulator.h"

namespace spelunk::test {

/// The shipped walker without sensors.
inline RobotModel walkerModel(double speed_mps = 0.5) {
  RobotModel robot;
  ParamTree tree;
  tree.addYamlFile(std::string(SPELUNK_SOURCE_DIR) + "/config/robots/walker.yaml");
  tree.read("robot", robot);
  robot.speed_max_mps = speed_mps;
  return robot;
}

/// Along straight lines at `speed_mps`, facing ahead, with a stop and a turn on the spot at each
/// corner. z is a flyer's.
inline Trajectory walkAlong(const std::vector<Eigen::Vector2d>& corners, double speed_mps,
                            double start_s) {
  constexpr double kAcceleration = 0.5;
  constexpr double kYawRate = 0.5;
  Trajectory trajectory;
  TrajectoryPoint point;
  point.time_s = start_s;
  const auto add = [&](double after_s, const Eigen::Vector2d& at, const Eigen::Vector2d& velocity) {
    point.time_s += after_s;
    point.pose.position = {at.x(), at.y(), 1.0};
    point.velocity = {velocity.x(), velocity.y(), 0.0};
    trajectory.push_back(point);
  };
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const Eigen::Vector2d leg = corners[k + 1] - corners[k];
    const Eigen::Vector2d along = leg.normalized();
    const double yaw = std::atan2(leg.y(), leg.x());
    const double turn = k == 0 ? 0.0 : std::abs(wrapAngle(yaw - point.pose.yaw));
    if (k > 0) point.pose.yaw = yaw;
    if (k == 0) {
      point.pose.yaw = yaw;
      add(0.0, corners[k], {0, 0});
    } else {
      add(std::max(0.1, turn / kYawRate), corners[k], {0, 0});
    }
    const double ramp_s = speed_mps / kAcceleration;
    const double ramp_m = 0.5 * speed_mps * ramp_s;
    add(ramp_s, corners[k] + ramp_m * along, speed_mps * along);
    add((leg.norm() - 2.0 * ramp_m) / speed_mps, corners[k + 1] - ramp_m * along,
        speed_mps * along);
    add(ramp_s, corners[k + 1], {0, 0});
  }
  return trajectory;
}

/// What happened on a walk.
struct Walked {
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  double end_yaw = 0.0;
  double worst_off_m = 0.0;  ///< Horizontally from the line between the corners.
  double worst_tilt_deg = 0.0;
  double lowest_z = 1e9;
  double highest_z = -1e9;
  sim::WalkerCount count;
  int trunk_contacts = 0;
};

inline double offLine(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& at) {
  double best = 1e9;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const Eigen::Vector2d leg = corners[k + 1] - corners[k];
    const double t = std::clamp((at - corners[k]).dot(leg) / leg.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (corners[k] + t * leg - at).norm());
  }
  return best;
}

/// Follows the corners and stands for 3 s (or lies).
inline Walked walk(sim::Simulator& sim, const std::vector<Eigen::Vector2d>& corners,
                   double speed_mps) {
  const Trajectory trajectory = walkAlong(corners, speed_mps, sim.time() + 0.3);
  sim.follow(trajectory);
  Walked walked;
  const double end_s = trajectory.back().time_s + 3.0;
  for (double t = sim.time() + 0.1; t < end_s; t += 0.1) {
    sim.advanceTo(t);
    const RobotState state = sim.trueState();
    const Eigen::Vector3d& at = state.pose.position;
    const double upright = (state.orientation * Eigen::Vector3d::UnitZ()).z();
    walked.worst_tilt_deg =
        std::max(walked.worst_tilt_deg, std::acos(std::clamp(upright, -1.0, 1.0)) * 180.0 / M_PI);
    walked.worst_off_m = std::max(walked.worst_off_m, offLine(corners, at.head<2>()));
    walked.lowest_z = std::min(walked.lowest_z, at.z());
    walked.highest_z = std::max(walked.highest_z, at.z());
  }
  walked.end = sim.trueState().pose.position;
  walked.end_yaw = sim.trueState().pose.yaw;
  walked.count = sim.walkerCount();
  walked.trunk_contacts = sim.collisions().episodes;
  return walked;
}

}  // namespace spelunk::test
