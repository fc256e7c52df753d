#include <algorithm>
#include <cmath>

#include "mission_impl.h"

namespace spelunk::mission {
namespace {

constexpr double kCheckPeriod_s = 0.25;
constexpr double kLookAhead_m = 2.0;     // beyond the way to a standstill
constexpr double kStopBefore_m = 0.6;    // bad ground, front of the footprint
constexpr double kUnseenBefore_m = 0.2;  // ground that should have been seen by now
constexpr double kStartRadius_m = 3.0;
constexpr double kSampling_s = 0.2;  // of the motion ahead
constexpr double kBackOff_m = 0.5;   // Dang 2020, section 4.3
constexpr double kBackOffSpeedShare = 0.4;
constexpr double kZoneMargin_m = 0.1;
constexpr double kZoneRadiusMin_m = 0.25;
constexpr double kZoneShrink_m = 0.05;
constexpr double kWalkedOn_m = 0.4;  // beside the trail
constexpr double kLateMax_s = 2.0;   // beyond it the mission holds
constexpr double kSamePlace_m = 0.5;
constexpr double kLook_s = 1.0;
constexpr double kWallReach_m = 0.8;  // full extents of where a wall is looked for
constexpr double kWallHeight_m = 0.5;
constexpr double kZoneDepth_m = 1.0;  // below and above the place
constexpr int kZoneCorners = 8;

NoGoZone zoneAround(const terrain::PathGroundCheck& bad, double radius_m, int number) {
  NoGoZone zone;
  zone.name = "ground " + std::to_string(number) + " (" + terrain::toText(bad.reason) + ")";
  for (int k = 0; k < kZoneCorners; ++k) {
    const double angle = 2.0 * M_PI * k / kZoneCorners;
    zone.polygon.push_back(bad.where.head<2>() +
                           radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  zone.z_min = bad.where.z() - kZoneDepth_m;
  zone.z_max = bad.where.z() + kZoneDepth_m;
  return zone;
}

/// The zone around bad ground, small enough to leave the robot outside.
NoGoZone zoneBeside(const terrain::PathGroundCheck& bad, const Eigen::Vector3d& robot_at,
                    const Eigen::Vector3d& box, int number) {
  double radius = std::max(bad.radius_m, kZoneRadiusMin_m) + kZoneMargin_m;
  NoGoZone zone = zoneAround(bad, radius, number);
  while (radius > kZoneShrink_m && sweptBoxMeets(zone, robot_at, robot_at, box)) {
    radius -= kZoneShrink_m;
    zone = zoneAround(bad, radius, number);
  }
  return zone;
}

}  // namespace

void Mission::Impl::noteGround(const Scan& scan) {
  if (!terrain || !input.latest()) return;
  static_cast<void>(terrain->insert(scan, T_world_base));
}

HomeGraph::Footing Mission::Impl::footingCheck() {
  if (!terrain) return {};
  return [rules = terrain::GroundRules::of(robot, map.params().resolution_m)](
             const map::FrozenMap& view, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return terrain::footingAlong(a, b, rules, terrain::lookupIn(view)) == terrain::Footing::kGood;
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
  // A busy computer looks late, and at scans that are old: the robot has walked on meanwhile.
  const double late_s = std::max(0.0, now - next_ground_check_s) + scanAge();
  next_ground_check_s = now + kCheckPeriod_s;
  const double speed = active->reference(now).velocity.norm();
  const double stop_m = brakingDistance(robot, speed) + speed * std::min(late_s, kLateMax_s);
  const auto check = terrain->checkPath(motionAhead(stop_m + kLookAhead_m), standing());
  const bool is_bad =
      check.status == terrain::PathGround::kUntraversable && check.arc_m < stop_m + kStopBefore_m;
  // Around the start, ground beside the robot has never been in any sensor's view.
  const bool has_left_start = distance(input.latest()->pose, home_graph->home()) > kStartRadius_m;
  const bool is_unseen = check.status == terrain::PathGround::kUnknown && has_left_start &&
                         check.arc_m < stop_m + kUnseenBefore_m;
  if ((!is_bad && !is_unseen) || wasWalkedOn(check) || isFootOfWall(check)) return;
  if (is_unseen && looksAgain(check.where)) return;
  avoid(check);
}

Pose Mission::Impl::standing() const {
  Pose pose = input.latest()->pose;
  pose.position.z() -= robot.box_lift_m;
  return pose;
}

double Mission::Impl::scanAge() const { return std::max(0.0, now - newest_scan_s); }

/// Ground may be unseen because scans are late or lost: the first time, waiting helps. False if the
/// robot has waited before the same place already.
bool Mission::Impl::looksAgain(const Eigen::Vector3d& unseen) {
  if (unseen_place && (*unseen_place - unseen).norm() < kSamePlace_m) return false;
  unseen_place = unseen;
  hold("ground ahead was not seen yet: standing to look again", planners::PathOutcome::kBlocked);
  next_ask_s = now + kLook_s;
  return true;
}

/// Whether all of the bad ground lies under where the robot has walked.
bool Mission::Impl::wasWalkedOn(const terrain::PathGroundCheck& bad) const {
  const Path& trail = home_graph->trail();
  for (std::size_t i = 1; i < trail.size(); ++i) {
    const Eigen::Vector3d& a = trail[i - 1].position;
    if (std::fabs(a.z() - robot.box_lift_m - bad.where.z()) > kZoneDepth_m) continue;
    const Eigen::Vector2d way = (trail[i].position - a).head<2>();
    const Eigen::Vector2d to = bad.where.head<2>() - a.head<2>();
    const double share = std::clamp(to.dot(way) / std::max(way.squaredNorm(), 1e-9), 0.0, 1.0);
    if ((to - share * way).norm() + bad.radius_m < kWalkedOn_m) return true;
  }
  return false;
}

/// Rough ground at a wall is the wall: what reaches up to the robot's box is avoided by its box.
bool Mission::Impl::isFootOfWall(const terrain::PathGroundCheck& bad) {
  if (bad.reason != terrain::GroundClass::kTooRough) return false;
  const Eigen::Vector3d beside = bad.where + Eigen::Vector3d(0.0, 0.0, robot.box_lift_m);
  bool has_wall = false;
  map.freeze()->forEachOccupied(boxAround(beside, {kWallReach_m, kWallReach_m, kWallHeight_m}),
                                [&](const map::VoxelIndex&) { has_wall = true; });
  return has_wall;
}

void Mission::Impl::avoid(const terrain::PathGroundCheck& bad) {
  NoGoZone zone =
      zoneBeside(bad, input.latest()->pose.position, robot.box_m, ++status.zones_marked);
  hold("untraversable ground ahead (" + std::string(terrain::toText(bad.reason)) +
           "): stopped, marked as " + zone.name + " at " + placeOf(bad.where) + ", going back",
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
