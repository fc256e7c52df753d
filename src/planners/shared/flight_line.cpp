#include "spelunk/planners/shared/flight_line.h"

#include <cmath>
#include <string>

namespace spelunk::planners {

Path toPath(const graph::Polyline& line, const Pose& start) {
  Path path{start};
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector3d step = line[i] - line[i - 1];
    constexpr double kUpright = 1e-6;  // no heading in a vertical step
    const double yaw =
        step.head<2>().norm() > kUpright ? std::atan2(step.y(), step.x()) : path.back().yaw;
    path.push_back({line[i], yaw});
  }
  return path;
}

Path pathFrom(const Pose& pose, const Eigen::Vector3d& root, const graph::Polyline& line) {
  Path path = toPath(line, {root, pose.yaw});
  if (root != pose.position) path.insert(path.begin(), pose);
  path.front() = pose;
  return path;
}

PlanResult homeResult(const PlanRequest& request, const Eigen::Vector3d& root,
                      const graph::Polyline& way, const PlanStats& stats) {
  PlanResult result;
  result.kind = PathKind::kHome;
  result.stats = stats;
  if (way.empty()) {
    result.status = PlanStatus::kNoPath;
    result.reason = "no free way along the trail leads home";
    return result;
  }
  result.status = PlanStatus::kOk;
  result.path = pathFrom(request.pose, root, way);
  result.reason = "way home, " + std::to_string(std::lround(lengthOf(result.path))) + " m";
  return result;
}

graph::Polyline toLine(const Path& path) {
  graph::Polyline line;
  for (const Pose& pose : path) line.push_back(pose.position);
  return line;
}

}  // namespace spelunk::planners
