#include "spelunk/common/self_return_watch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "spelunk/common/box.h"
#include "spelunk/common/message_text.h"

namespace spelunk {
namespace {

constexpr double kCell_m = 0.1;          // noise of a range and of the mounting stay below it
constexpr double kSteadyShare = 0.9;     // of the scans; a turning propeller misses some
constexpr int kScansAtRest = 10;         // a second of a common LiDAR
constexpr int kScansInMotion = 5;        // a fast robot takes no more along its own length
constexpr std::size_t kLooksMax = 150;   // places that are looked for again
constexpr double kNeighbour_m = 0.4;     // of a place
constexpr std::size_t kPlacesLeast = 3;  // less is a speck
constexpr float kFarBeyond = 0.5F;       // of the distance: less is the same floor, seen aslant
constexpr double kMargin_m = 0.1;        // of the remedies

std::array<int, 3> cellOf(const Eigen::Vector3d& p_base) {
  const Eigen::Array3i cell = (p_base / kCell_m).array().floor().cast<int>();
  return {cell.x(), cell.y(), cell.z()};
}

std::ptrdiff_t countNear(const Eigen::Vector3d& place, const std::vector<Eigen::Vector3d>& places) {
  return std::count_if(places.begin(), places.end(), [&](const Eigen::Vector3d& other) {
    return (other - place).squaredNorm() < kNeighbour_m * kNeighbour_m;
  });
}

/// What a scan shows where something was, `was_m` from the sensor then. Something as far from the
/// sensor in its way is the same part of the robot again; a nearer part only hides the place.
enum class Sight { kNothing, kStillThere, kGone };

Sight sightOf(const Eigen::Vector3d& p_sensor, double was_m,
              const std::vector<Eigen::Vector3f>& points, const std::vector<float>& ranges,
              const std::vector<char>& is_steady) {
  const auto distance = static_cast<float>(p_sensor.norm());
  const Eigen::Vector3f direction = p_sensor.normalized().cast<float>();
  const auto cell = static_cast<float>(kCell_m);
  const float least_cosine = std::cos(0.5F * cell / std::max(distance, cell));
  Sight sight = Sight::kNothing;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].dot(direction) < least_cosine * ranges[i]) continue;
    const float beyond = ranges[i] - distance;
    if (std::abs(beyond) <= 2.0F * cell) return Sight::kStillThere;
    const bool is_same_part =
        is_steady[i] != 0 && std::abs(ranges[i] - static_cast<float>(was_m)) <= cell;
    if (beyond > kFarBeyond * distance || (beyond < 0.0F && is_same_part)) sight = Sight::kGone;
  }
  return sight;
}

std::string metres(double value) { return withNumber("%.2f", value); }

}  // namespace

SelfReturnWatch::SelfReturnWatch(const RobotModel& robot, double range_min_m)
    : robot_(robot), range_min_m_(range_min_m), reach_m_(robot.box_m.norm()) {}

void SelfReturnWatch::look(const std::vector<Eigen::Vector3f>& points,
                           const Eigen::Isometry3d& T_base_sensor,
                           const Eigen::Isometry3d& T_world_base) {
  if (!T_world_anchor_) T_world_anchor_ = T_world_base;
  count(points, T_base_sensor);
  const double moved_m = (T_world_base.translation() - T_world_anchor_->translation()).norm();
  if (moved_m >= reach_m_) {
    judgeAfterMotion(points, T_base_sensor, T_world_base);
    has_moved_ = true;
    beginAnew(T_world_base);
  } else if (scans_ % kScansAtRest == 0) {
    judgeAtRest(T_base_sensor);
    if (moved_m < kCell_m) beginAnew(T_world_base);  // What has gone meanwhile is not counted on.
  }
}

void SelfReturnWatch::beginAnew(const Eigen::Isometry3d& T_world_base) {
  cells_.clear();
  scans_ = 0;
  T_world_anchor_ = T_world_base;
}

void SelfReturnWatch::count(const std::vector<Eigen::Vector3f>& points,
                            const Eigen::Isometry3d& T_base_sensor) {
  ++scans_;
  const Eigen::Vector3d centre(0.0, 0.0, robot_.box_lift_m);
  const AxisAlignedBox body = boxAround(centre, kBodyShare * robot_.box_m);
  const double far = reach_m_ + (T_base_sensor.translation() - centre).norm();
  const auto far_squared = static_cast<float>(far * far);
  const auto near_squared = static_cast<float>(range_min_m_ * range_min_m_);
  std::map<Cell, Eigen::Vector3d> hit;
  for (const Eigen::Vector3f& point : points) {
    const float squared = point.squaredNorm();
    if (!(squared >= near_squared && squared <= far_squared)) continue;
    const Eigen::Vector3d p_base = T_base_sensor * point.cast<double>();
    if ((p_base - centre).norm() > reach_m_ || body.contains(p_base)) continue;
    hit[cellOf(p_base)] = p_base;
  }
  for (const auto& [cell, p_base] : hit) {
    Hits& hits = cells_[cell];
    ++hits.scans;
    hits.p_base = p_base;
  }
}

bool SelfReturnWatch::isSteady(const Hits& hits) const {
  return hits.scans >= kSteadyShare * scans_;
}

/// Places that are hit in nearly every scan, at most kLooksMax of them, spread evenly.
std::vector<Eigen::Vector3d> SelfReturnWatch::steadyPlaces() const {
  std::vector<Eigen::Vector3d> all;
  for (const auto& [cell, hits] : cells_)
    if (isSteady(hits)) all.push_back(hits.p_base);
  std::vector<Eigen::Vector3d> places;
  const std::size_t stride = 1 + all.size() / kLooksMax;
  for (std::size_t i = 0; i < all.size(); i += stride) places.push_back(all[i]);
  return places;
}

void SelfReturnWatch::judgeAtRest(const Eigen::Isometry3d& T_base_sensor) {
  const Eigen::Vector3d centre(0.0, 0.0, robot_.box_lift_m);
  const AxisAlignedBox safety_box = boxAround(centre, robot_.box_m);
  std::vector<Eigen::Vector3d> inside;
  std::vector<Eigen::Vector3d> beside;
  for (const auto& [cell, hits] : cells_) {
    if (!isSteady(hits)) continue;
    if (safety_box.contains(hits.p_base)) inside.push_back(hits.p_base);
    if (std::abs(hits.p_base.z() - centre.z()) <= 0.5 * robot_.box_m.z())
      beside.push_back(hits.p_base);
  }
  doubt_.clear();
  if (beside.size() >= kPlacesLeast) {
    const Spread spread = spreadOf(beside, T_base_sensor);
    doubt_ =
        "something " + metres(spread.nearest_m) + " to " + metres(spread.farthest_m) +
        " m from the sensor, beside the robot, is in every scan: walls, or else its own parts" +
        remedyFor(spread);
  }
  if (has_moved_) return;
  finding_.clear();
  if (inside.size() < kPlacesLeast) return;
  const Spread spread = spreadOf(inside, T_base_sensor);
  finding_ = "returns " + metres(spread.nearest_m) + " to " + metres(spread.farthest_m) +
             " m from the sensor lie inside the robot's own box (" + toText(robot_.box_m) +
             " m) in every scan: move the robot if they are obstacles; if they are its own parts" +
             remedyFor(spread);
}

void SelfReturnWatch::judgeAfterMotion(const std::vector<Eigen::Vector3f>& points,
                                       const Eigen::Isometry3d& T_base_sensor,
                                       const Eigen::Isometry3d& T_world_base) {
  doubt_.clear();
  if (scans_ < kScansInMotion) return finding_.clear();
  const std::vector<Eigen::Vector3d> suspected =
      std::exchange(suspected_, ownPlaces(points, T_base_sensor, T_world_base));
  if (suspected_.size() < kPlacesLeast) return finding_.clear();
  std::vector<Eigen::Vector3d> own;
  for (const Eigen::Vector3d& place : suspected_)
    if (countNear(place, suspected) > 0) own.push_back(place);
  if (own.size() < kPlacesLeast) return;  // the next motion will tell
  const Spread spread = spreadOf(own, T_base_sensor);
  finding_ = "returns " + metres(spread.nearest_m) + " to " + metres(spread.farthest_m) +
             " m from the sensor move with the robot, they are its own parts" + remedyFor(spread);
  const AxisAlignedBox safety_box =
      boxAround({0.0, 0.0, robot_.box_lift_m}, robot_.box_m + Eigen::Vector3d::Constant(kCell_m));
  if (!std::all_of(own.begin(), own.end(),
                   [&](const Eigen::Vector3d& place) { return safety_box.contains(place); }))
    finding_ += ", and robot.box_m (now " + toText(robot_.box_m) + ") so that it holds them";
}

/// The steady places that are not where they were any more, each with most of its neighbours: a
/// wall beside the robot has single ones at its rims.
std::vector<Eigen::Vector3d> SelfReturnWatch::ownPlaces(
    const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_base_sensor,
    const Eigen::Isometry3d& T_world_base) const {
  std::vector<float> ranges;
  std::vector<char> is_steady;
  for (const Eigen::Vector3f& point : points) {
    ranges.push_back(point.norm());
    const auto hits = cells_.find(cellOf(T_base_sensor * point.cast<double>()));
    is_steady.push_back(hits != cells_.end() && isSteady(hits->second));
  }
  const Eigen::Isometry3d T_sensor_anchor =
      (T_world_base * T_base_sensor).inverse() * *T_world_anchor_;
  std::vector<Eigen::Vector3d> gone;
  std::vector<Eigen::Vector3d> still_there;
  for (const Eigen::Vector3d& place : steadyPlaces()) {
    const double was_m = (place - T_base_sensor.translation()).norm();
    const Sight sight = sightOf(T_sensor_anchor * place, was_m, points, ranges, is_steady);
    if (sight == Sight::kGone) gone.push_back(place);
    if (sight == Sight::kStillThere) still_there.push_back(place);
  }
  std::vector<Eigen::Vector3d> own;
  for (const Eigen::Vector3d& place : gone)
    if (countNear(place, gone) > countNear(place, still_there)) own.push_back(place);
  return own;
}

SelfReturnWatch::Spread SelfReturnWatch::spreadOf(const std::vector<Eigen::Vector3d>& places,
                                                  const Eigen::Isometry3d& T_base_sensor) const {
  Spread spread;
  AxisAlignedBox box{places.front(), places.front()};
  spread.nearest_m = (places.front() - T_base_sensor.translation()).norm();
  for (const Eigen::Vector3d& place : places) {
    const double range = (place - T_base_sensor.translation()).norm();
    spread.nearest_m = std::min(spread.nearest_m, range);
    spread.farthest_m = std::max(spread.farthest_m, range);
    box.min = box.min.cwiseMin(place);
    box.max = box.max.cwiseMax(place);
  }
  const Eigen::Vector3d centre = 0.5 * (box.min + box.max);
  const Eigen::Vector3d size = box.size() + Eigen::Vector3d::Constant(2.0 * kMargin_m);
  spread.box = "[" + metres(centre.x()) + ", " + metres(centre.y()) + ", " + metres(centre.z()) +
               ", " + metres(size.x()) + ", " + metres(size.y()) + ", " + metres(size.z()) + "]";
  return spread;
}

std::string SelfReturnWatch::remedyFor(const Spread& spread) const {
  return ", set robot.self_filter_boxes_m: " + spread.box +
         " or map.range_min_m: " + metres(spread.farthest_m + kMargin_m);
}

}  // namespace spelunk
