#include "spelunk/mission/ground_watch.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/message_text.h"

namespace spelunk::mission {
namespace {

constexpr double kCheckPeriod_s = 0.25;  // a robot that walks comes no farther than a foot's length
constexpr double kLookAhead_m = 2.0;     // beyond the way to a standstill
constexpr double kStopBefore_m = 0.6;    // bad ground, front of the footprint
constexpr double kUnseenBefore_m = 0.2;  // ground that should have been seen by now
/// Around the start, ground beside the robot has never been in any sensor's view.
constexpr double kStartRadius_m = 3.0;
constexpr double kSampling_s = 0.2;  // of the motion ahead
constexpr double kBackOff_m = 0.5;   // Dang 2020, section 4.3
constexpr double kZoneMargin_m = 0.1;
constexpr double kZoneRadiusMin_m = 0.25;  // a foot's length: a smaller zone is stepped around
constexpr double kZoneShrink_m = 0.05;
constexpr double kWalkedOn_m = 0.4;  // beside the trail: within the feet's track
constexpr double kLateMax_s = 2.0;   // beyond it the mission holds
constexpr double kSamePlace_m = 0.5;
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

GroundWatch::GroundWatch(const Basis& basis, const terrain::TerrainParams& params) : basis_(basis) {
  if (kindOf(basis.robot) == RobotKind::kLegged) terrain_.emplace(params);
}

void GroundWatch::assumeGroundHere() {
  if (terrain_) terrain_->assumeGroundUnder(basis_.watch.T_world_base());
}

void GroundWatch::noteScan(const Scan& scan) {
  if (terrain_ && basis_.watch.knowsPose())
    static_cast<void>(terrain_->insert(scan, basis_.watch.T_world_base()));
}

std::shared_ptr<const terrain::TerrainView> GroundWatch::view() {
  return terrain_ ? terrain_->freeze() : nullptr;
}

void GroundWatch::reset() {
  backs_off_ = false;
  unseen_place_.reset();
}

/// The poses of the base on the next metres of the motion.
Path GroundWatch::motionAhead(double length_m, double now_s) const {
  const PathExecution& active = *basis_.flight.active();
  Path ahead;
  const double first_arc = active.arcAt(now_s);
  for (double time = now_s; time <= active.endTime(); time += kSampling_s) {
    Pose pose = active.reference(time).pose;
    pose.position.z() -= basis_.robot.box_lift_m;
    ahead.push_back(pose);
    if (active.arcAt(time) - first_arc > length_m) break;
  }
  return ahead;
}

std::optional<GroundFinding> GroundWatch::look(const Path& trail, double now_s) {
  if (!terrain_ || !basis_.params.verify_ground || !basis_.flight.active() || backs_off_ ||
      now_s < next_check_s_)
    return std::nullopt;
  // A busy computer looks late, and at scans that are old: the robot has walked on meanwhile.
  const double late_s = std::max(0.0, now_s - next_check_s_) + basis_.watch.scanAge(now_s);
  next_check_s_ = now_s + kCheckPeriod_s;
  const double speed = basis_.flight.active()->reference(now_s).velocity.norm();
  const double stop_m = brakingDistance(basis_.robot, speed) + speed * std::min(late_s, kLateMax_s);
  const auto check =
      terrain_->checkPath(motionAhead(stop_m + kLookAhead_m, now_s), basis_.watch.basePose());
  const bool is_bad =
      check.status == terrain::PathGround::kUntraversable && check.arc_m < stop_m + kStopBefore_m;
  const bool has_left_start = distance(basis_.watch.pose(), trail.front()) > kStartRadius_m;
  const bool is_unseen = check.status == terrain::PathGround::kUnknown && has_left_start &&
                         check.arc_m < stop_m + kUnseenBefore_m;
  if ((!is_bad && !is_unseen) || wasWalkedOn(check, trail) || isFootOfWall(check))
    return std::nullopt;
  GroundFinding finding;
  // Ground may be unseen because scans are late or lost: the first time, waiting helps.
  if (is_unseen && !hasWaitedBefore(check.where)) {
    unseen_place_ = check.where;
    finding.why = "ground ahead was not seen yet: standing to look again";
    return finding;
  }
  finding.kind = GroundFinding::Kind::kUntraversable;
  finding.zone = zoneBeside(check, basis_.watch.pose().position, basis_.robot.box_m,
                            basis_.space.zones().markedCount() + 1);
  finding.why = "untraversable ground ahead (" + std::string(terrain::toText(check.reason)) +
                "): stopped, marked as " + finding.zone.name + " at " + placeOf(check.where) +
                ", going back";
  return finding;
}

bool GroundWatch::hasWaitedBefore(const Eigen::Vector3d& unseen) const {
  return unseen_place_ && (*unseen_place_ - unseen).norm() < kSamePlace_m;
}

/// Whether all of the bad ground lies under where the robot has walked.
bool GroundWatch::wasWalkedOn(const terrain::PathGroundCheck& bad, const Path& trail) const {
  for (std::size_t i = 1; i < trail.size(); ++i) {
    const Eigen::Vector3d& a = trail[i - 1].position;
    if (std::fabs(a.z() - basis_.robot.box_lift_m - bad.where.z()) > kZoneDepth_m) continue;
    const Eigen::Vector2d way = (trail[i].position - a).head<2>();
    const Eigen::Vector2d to = bad.where.head<2>() - a.head<2>();
    const double share = std::clamp(to.dot(way) / std::max(way.squaredNorm(), 1e-9), 0.0, 1.0);
    if ((to - share * way).norm() + bad.radius_m < kWalkedOn_m) return true;
  }
  return false;
}

/// Rough ground at a wall is the wall: what reaches up to the robot's box is avoided by its box.
bool GroundWatch::isFootOfWall(const terrain::PathGroundCheck& bad) const {
  if (bad.reason != terrain::GroundClass::kTooRough) return false;
  const Eigen::Vector3d beside = bad.where + Eigen::Vector3d(0.0, 0.0, basis_.robot.box_lift_m);
  bool has_wall = false;
  basis_.space.map().freeze()->forEachOccupied(
      boxAround(beside, {kWallReach_m, kWallReach_m, kWallHeight_m}),
      [&](const map::VoxelIndex&) { has_wall = true; });
  return has_wall;
}

/// What lies behind has been walked on.
Path GroundWatch::takeWayBack(const Path& trail) {
  backs_off_ = false;
  Path back{basis_.watch.pose()};
  double length = 0.0;
  for (auto it = trail.rbegin(); it != trail.rend() && length < kBackOff_m; ++it) {
    const double step = distance(*it, back.back());
    if (step < 1e-3) continue;
    back.push_back(*it);
    length += step;
  }
  return back.size() < 2 ? Path{} : slice(back, 0.0, kBackOff_m);
}

}  // namespace spelunk::mission
