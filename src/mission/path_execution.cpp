#include "spelunk/mission/path_execution.h"

#include <algorithm>

#include "spelunk/common/contract.h"

namespace spelunk::mission {
namespace {

Path lineOf(const Trajectory& trajectory) {
  require(!trajectory.empty(), "PathExecution: empty trajectory");
  Path line;
  line.reserve(trajectory.size());
  for (const TrajectoryPoint& point : trajectory) line.push_back(point.pose);
  return line;
}

std::vector<double> arcsOf(const Path& line) {
  std::vector<double> arcs{0.0};
  for (std::size_t i = 1; i < line.size(); ++i)
    arcs.push_back(arcs.back() + distance(line[i - 1], line[i]));
  return arcs;
}

}  // namespace

PathExecution::PathExecution(Path waypoints, Trajectory trajectory, planners::PathKind kind,
                             const Eigen::Vector3d& box, double resolution_m)
    : waypoints_(std::move(waypoints)),
      trajectory_(std::move(trajectory)),
      kind_(kind),
      box_(box),
      line_(lineOf(trajectory_)),
      arc_m_(arcsOf(line_)),
      monitor_(line_, box, resolution_m) {}

TrajectoryPoint PathExecution::reference(double time_s) const {
  return stateAt(trajectory_, time_s);
}

double PathExecution::arcAt(double time_s) const {
  const auto next = std::upper_bound(
      trajectory_.begin(), trajectory_.end(), time_s,
      [](double time, const TrajectoryPoint& point) { return time < point.time_s; });
  if (next == trajectory_.begin()) return 0.0;
  const auto i = static_cast<std::size_t>(next - trajectory_.begin()) - 1;
  const double along = (reference(time_s).pose.position - line_[i].position).norm();
  const double rest = i + 1 < arc_m_.size() ? arc_m_[i + 1] - arc_m_[i] : 0.0;
  return arc_m_[i] + std::min(along, rest);
}

double PathExecution::nearestArc(const Eigen::Vector3d& position, double from_m,
                                 double to_m) const {
  double best_arc = std::clamp(from_m, 0.0, length());
  double least = (poseAt(line_, best_arc).position - position).norm();
  for (std::size_t i = 1; i < line_.size(); ++i) {
    const double step = arc_m_[i] - arc_m_[i - 1];
    if (arc_m_[i] < from_m || arc_m_[i - 1] > to_m || step <= 0.0) continue;
    const Eigen::Vector3d& a = line_[i - 1].position;
    const Eigen::Vector3d way = line_[i].position - a;
    const double share = std::clamp((position - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const double gap = (a + share * way - position).norm();
    if (gap >= least) continue;
    least = gap;
    best_arc = arc_m_[i - 1] + share * step;
  }
  return best_arc;
}

Path PathExecution::line(double from_m, double to_m) const { return slice(line_, from_m, to_m); }

void PathExecution::noteOccupied(const std::vector<map::VoxelIndex>& voxels, double now_s) {
  const auto hit = monitor_.firstHit(voxels, arcAt(now_s));
  if (hit && (!blocked_arc_m_ || *hit < *blocked_arc_m_)) blocked_arc_m_ = hit;
}

}  // namespace spelunk::mission
