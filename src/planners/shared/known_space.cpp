#include "spelunk/planners/shared/known_space.h"

namespace spelunk::planners {

KnownSpace::KnownSpace(const PlanRequest& request, const RobotModel& robot,
                       navigation::Navigator& navigator, map::ConfigurationSpace& boxes)
    : request_(request),
      robot_(robot),
      navigator_(navigator),
      boxes_(boxes),
      free_(
          [this](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return boxes_.sweep(a, b); },
          robot.box_m, request.bounds, request.zones) {
  boxes_.use(request.map);
}

bool KnownSpace::isFree(const graph::Polyline& line) const {
  for (std::size_t i = 1; i < line.size(); ++i)
    if (!free_.isFree(line[i - 1], line[i])) return false;
  return true;
}

graph::Polyline KnownSpace::shortened(const graph::Polyline& line, double reach_m) const {
  graph::Polyline kept;
  if (!line.empty()) kept.push_back(line.front());
  for (std::size_t at = 0; at + 1 < line.size();) {
    std::size_t farthest = at + 1;
    double arc = (line[at + 1] - line[at]).norm();
    for (std::size_t next = at + 2; next < line.size(); ++next) {
      arc += (line[next] - line[next - 1]).norm();
      if (arc > reach_m) break;
      if (free_.isFree(line[at], line[next])) farthest = next;
    }
    kept.push_back(line[farthest]);
    at = farthest;
  }
  return kept;
}

navigation::NavigationAnswer KnownSpace::navigate(const Eigen::Vector3d& from,
                                                  const Eigen::Vector3d& to,
                                                  const std::string& stream,
                                                  navigation::TreeDetail trees) {
  navigation::NavigationQuery query;
  query.map = request_.map;
  query.start.position = from;
  query.goal.position = to;
  query.box = robot_.box_m;
  query.bounds = request_.bounds;
  query.zones = request_.zones;
  query.region = navigation::SearchRegion::kKnown;
  query.trees = trees;
  query.time_limit_s = request_.budget.seconds;
  query.rng = request_.rng.fork("navigate/" + stream);
  return navigator_.plan(query);
}

}  // namespace spelunk::planners
