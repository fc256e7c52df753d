#include "spelunk/mission/zones.h"

#include <cmath>
#include <string>
#include <utility>

#include "spelunk/common/params.h"

namespace spelunk::mission {
namespace {

/// "(1.5, -2, 0.8)", metres.
std::string textOf(const Eigen::Vector3d& point) {
  const auto rounded = [](double value) { return toText(std::round(100.0 * value) / 100.0); };
  return "(" + rounded(point.x()) + ", " + rounded(point.y()) + ", " + rounded(point.z()) + ")";
}

}  // namespace

Answer Zones::setBounds(const AxisAlignedBox& bounds,
                        const std::optional<Eigen::Vector3d>& robot_at) {
  if (bounds.isEmpty() || bounds.min.hasNaN() || bounds.max.hasNaN())
    return {false, "the bounds are empty: min must lie below max on each axis"};
  if (robot_at && !bounds.contains(*robot_at))
    return {false, "the bounds exclude the robot: it is at " + textOf(*robot_at) +
                       ", they reach from " + textOf(bounds.min) + " to " + textOf(bounds.max) +
                       "; choose them around it"};
  bounds_ = bounds;
  return {true, "bounds set"};
}

std::string Zones::faultOf(const NoGoZone& zone,
                           const std::optional<Eigen::Vector3d>& robot_at) const {
  if (zone.polygon.size() < 3) return "no-go zone '" + zone.name + "' needs at least three corners";
  if (!(zone.z_min < zone.z_max))
    return "no-go zone '" + zone.name + "': z_min must lie below z_max";
  if (robot_at && sweptBoxMeets(zone, *robot_at, *robot_at, box_))
    return "no-go zone '" + zone.name + "' holds the robot: move it out first";
  return "";
}

Answer Zones::setGiven(std::vector<NoGoZone> zones,
                       const std::optional<Eigen::Vector3d>& robot_at) {
  for (const NoGoZone& zone : zones)
    if (const std::string fault = faultOf(zone, robot_at); !fault.empty()) return {false, fault};
  const std::vector<NoGoZone> kept = marked();
  given_ = std::move(zones);
  join(kept);
  return {true, std::to_string(given_.size()) + " no-go zone(s) set"};
}

void Zones::mark(NoGoZone zone) {
  all_.push_back(std::move(zone));
  ++revision_;
}

void Zones::restore(const AxisAlignedBox& bounds, std::vector<NoGoZone> given,
                    const std::vector<NoGoZone>& marked) {
  bounds_ = bounds;
  given_ = std::move(given);
  join(marked);
}

void Zones::join(const std::vector<NoGoZone>& marked) {
  all_ = given_;
  all_.insert(all_.end(), marked.begin(), marked.end());
  ++revision_;
}

std::vector<NoGoZone> Zones::marked() const {
  return {all_.begin() + static_cast<long>(given_.size()), all_.end()};
}

int Zones::markedCount() const { return static_cast<int>(all_.size() - given_.size()); }

std::string Zones::problemAt(const Eigen::Vector3d& robot_at) const {
  if (!bounds_.contains(robot_at))
    return "the robot stands outside the bounds: widen them or move it";
  for (const NoGoZone& zone : all_)
    if (sweptBoxMeets(zone, robot_at, robot_at, box_))
      return "the robot stands in no-go zone '" + zone.name + "': remove it or move the robot";
  return "";
}

}  // namespace spelunk::mission
