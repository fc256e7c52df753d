#include <algorithm>
#include <cmath>

#include "mission_impl.h"

namespace spelunk::mission {
namespace {

constexpr double kCheckPeriod_s = 0.25;
constexpr double kLookAhead_m = 2.0;     // beyond the way to a standstill
constexpr double kStopBefore_m = 0.6;    // bad ground, front of the footprint
constexpr double kUnseenBefore_m = 0.2;  // ground that should have been seen by now
constexpr double kSampling_s = 0.2;      // of the motion ahead
constexpr double kBackOff_m = 0.5;       // Dang 2020, section 4.3
constexpr double kBackOffSpeedShare = 0.4;
constexpr double kZoneMargin_m = 0.1;
constexpr double kZoneRadiusMin_m = 0.25;
constexpr double kZoneDepth_m = 1.0;  // below and above the place
constexpr int kZoneCorners = 8;

NoGoZone zoneAround(const terrain::PathGroundCheck& bad, int number) {
  NoGoZone zone;
  zone.name = "ground " + std::to_string(number) + " (" + terrain::toText(bad.reason) + ")";
  const double radius = std::max(bad.radius_m, kZoneRadiusMin_m) + kZoneMargin_m;
  for (int k = 0; k < kZoneCorners; ++k) {
    const double angle = 2.0 * M_PI * k / kZoneCorners;
    zone.polygon.push_back(bad.where.head<2>() +
                           radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  zone.z_min = bad.where.z() - kZoneDepth_m;
  zone.z_max = bad.where.z() + kZoneDepth_m;
  return zone;
}

}  // namespace

void Mission::Impl::noteGround(const Scan& scan) {
  if (terrain && input.latest()) static_cast<void>(terrain->insert(scan, T_world_base));
}

HomeGraph::Footing Mission::Impl::footingCheck() {
  if (!terrain) return {};
  return [rules = terrain::GroundRules::of(robot, map.params().resolution_m)](
             const map::FrozenMap& view, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const auto lookup = [&view](const Eigen::Vector3d& point, double distance_m) {
      return terrain::groundBelow(view, point, distance_m);
    };
    return terrain::footingAlong(a, b, rules, lookup) == terrain::Footing::kGood;
  };
}

bool Mission::Impl::isWalkable(const Path& path) {
  if (!terrain) return true;
  const auto view = map.freeze();
  const HomeGraph::Footing footing = footingCheck();
  for (std::size_t i = 1; i < path.size(); ++i)
    if (!footing(*view, path[i - 1].position, path[i].position)) return false;
  return true;
}

/// The poses of the base on the next metres of the motion.
Path Mission::Impl::motionAhead(double length_m) const {
  Path ahead;
  const double first_arc = active->arcAt(now);
  for (double time = now; time <= active->endTime(); time += kSampling_s) {
    Pose pose = active->reference(time).pose;
    pose.position.z() -= robot.box_lift_m;
    ahead.push_back(pose);
    if (active->arcAt(time) - first_arc > length_m) break;
  }
  return ahead;
}

void Mission::Impl::checkGround() {
  if (!terrain || !params.verify_ground || !active || backs_off || now < next_ground_check_s)
    return;
  next_ground_check_s = now + kCheckPeriod_s;
  const double stop_m = brakingDistance(robot, active->reference(now).velocity.norm());
  const auto check = terrain->checkPath(motionAhead(stop_m + kLookAhead_m));
  const bool is_bad =
      check.status == terrain::PathGround::kUntraversable && check.arc_m < stop_m + kStopBefore_m;
  const bool is_unseen =
      check.status == terrain::PathGround::kUnknown && check.arc_m < stop_m + kUnseenBefore_m;
  if (is_bad || is_unseen) avoid(check);
}

void Mission::Impl::avoid(const terrain::PathGroundCheck& bad) {
  NoGoZone zone = zoneAround(bad, ++status.zones_marked);
  hold("untraversable ground ahead (" + std::string(terrain::toText(bad.reason)) +
           "): stopped, marked as " + zone.name + ", going back",
       planners::PathOutcome::kBlocked);
  home_graph->noteZone(zone);
  no_go.push_back(std::move(zone));
  backs_off = true;
}

/// Backwards along the trail, without turning: what lies behind has been walked on.
void Mission::Impl::stepBackOff() {
  if (!backs_off) return;
  if (active || !inputs_ok || !isAtRest()) return;
  backs_off = false;
  const Pose here = input.latest()->pose;
  const Path& trail = home_graph->trail();
  Path back{here};
  double length = 0.0;
  for (auto it = trail.rbegin(); it != trail.rend() && length < kBackOff_m; ++it) {
    const double step = distance(*it, back.back());
    if (step < 1e-3) continue;
    back.push_back(*it);
    length += step;
  }
  if (back.size() < 2) return;
  back = slice(back, 0.0, kBackOff_m);
  for (Pose& pose : back) pose.yaw = here.yaw + M_PI;
  MotionLimits limits_back = limitsOf(robot);
  limits_back.speed_mps *= kBackOffSpeedShare;
  Trajectory trajectory = navigation::timed(back, limits_back, {now, Eigen::Vector3d::Zero(), 0.0});
  for (TrajectoryPoint& point : trajectory) {
    point.pose.yaw = here.yaw;
    point.yaw_rate = 0.0;
  }
  for (Pose& pose : back) pose.yaw = here.yaw;
  active.emplace(back, trajectory, planners::PathKind::kLocal, kBodyShare * robot.box_m,
                 map.params().resolution_m);
  command = Command{std::move(back), std::move(trajectory), planners::PathKind::kLocal};
}

}  // namespace spelunk::mission
