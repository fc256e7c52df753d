#include "spelunk/common/trajectory.h"

#include <algorithm>

#include "spelunk/common/contract.h"

namespace spelunk {
namespace {

TrajectoryPoint atRest(const TrajectoryPoint& point, double time_s) {
  return {time_s, point.pose, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};
}

TrajectoryPoint hermite(const TrajectoryPoint& a, const TrajectoryPoint& b, double time_s) {
  const double h = b.time_s - a.time_s;
  const double u = (time_s - a.time_s) / h;
  const Eigen::Vector3d& p0 = a.pose.position;
  const Eigen::Vector3d& p1 = b.pose.position;
  const Eigen::Vector3d m0 = h * a.velocity;
  const Eigen::Vector3d m1 = h * b.velocity;
  TrajectoryPoint out;
  out.time_s = time_s;
  out.pose.position = p0 + u * m0 + u * u * (3.0 * (p1 - p0) - 2.0 * m0 - m1) +
                      u * u * u * (2.0 * (p0 - p1) + m0 + m1);
  out.velocity = (m0 + 2.0 * u * (3.0 * (p1 - p0) - 2.0 * m0 - m1) +
                  3.0 * u * u * (2.0 * (p0 - p1) + m0 + m1)) /
                 h;
  out.acceleration =
      (2.0 * (3.0 * (p1 - p0) - 2.0 * m0 - m1) + 6.0 * u * (2.0 * (p0 - p1) + m0 + m1)) / (h * h);
  const double turn = wrapAngle(b.pose.yaw - a.pose.yaw);
  out.pose.yaw = wrapAngle(a.pose.yaw + u * turn);
  out.yaw_rate = turn / h;
  return out;
}

}  // namespace

TrajectoryPoint stateAt(const Trajectory& trajectory, double time_s) {
  require(!trajectory.empty(), "stateAt: empty trajectory");
  if (time_s < trajectory.front().time_s) return atRest(trajectory.front(), time_s);
  if (time_s >= trajectory.back().time_s) return atRest(trajectory.back(), time_s);
  const auto next = std::upper_bound(
      trajectory.begin(), trajectory.end(), time_s,
      [](double time, const TrajectoryPoint& point) { return time < point.time_s; });
  return hermite(*(next - 1), *next, time_s);
}

}  // namespace spelunk
