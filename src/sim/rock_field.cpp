#include "spelunk/sim/rock_field.h"

#include <algorithm>
#include <cmath>

#include "spelunk/sim/rock_noise.h"

namespace spelunk::sim {
namespace {

constexpr double kRock = 1e3;

constexpr double kContrast = 1.7;  ///< Value noise seldom comes near its ends.

double mix(double a, double b, double t) { return a + (b - a) * t; }

/// Signed distance to a rounded corner region q <= 0 of two half spaces.
double roundedCorner(double qx, double qy, double radius) {
  const double x = qx + radius;
  const double y = qy + radius;
  const double outside =
      std::sqrt(std::max(x, 0.0) * std::max(x, 0.0) + std::max(y, 0.0) * std::max(y, 0.0));
  return outside + std::min(std::max(x, y), 0.0) - radius;
}

/// Signed distance to a box, negative inside.
double boxDistance(const Eigen::Vector3d& from_centre, const Eigen::Vector3d& half) {
  const Eigen::Vector3d q = from_centre.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

constexpr double kPitRim = 0.3;  ///< A pit's box reaches so far above the floor.

AxisAlignedBox boxOf(const Block& block) {
  return {block.centre - 0.5 * block.size, block.centre + 0.5 * block.size};
}

AxisAlignedBox boxOf(const Pit& pit) {
  const Eigen::Vector3d half(0.5 * pit.size.x(), 0.5 * pit.size.y(), 0.0);
  return {pit.top - half - Eigen::Vector3d(0.0, 0.0, pit.depth),
          pit.top + half + Eigen::Vector3d(0.0, 0.0, kPitRim)};
}

double distanceTo(const AxisAlignedBox& box, const Eigen::Vector3d& point) {
  return boxDistance(point - 0.5 * (box.min + box.max), 0.5 * (box.max - box.min));
}

}  // namespace

RockField::RockField(const WorldPlan& plan)
    : pillars_(plan.pillars),
      blocks_(plan.blocks),
      pits_(plan.pits),
      roughness_m_(plan.roughness_m),
      blend_m_(plan.blend_m),
      grain_m_(plan.grain_m),
      cell_m_(plan.cell_m),
      seed_(plan.seed) {
  for (const Pit& pit : pits_) deepest_pit_m_ = std::max(deepest_pit_m_, pit.depth);
  int group = 0;
  for (const Passage& passage : plan.passages) {
    for (std::size_t i = 1; i < passage.stations.size(); ++i)
      add({Shape::kSegment,
           group,
           passage.stations[i - 1],
           passage.stations[i],
           {},
           {},
           passage.root_m});
    ++group;
  }
  for (const Chamber& chamber : plan.chambers)
    add({Shape::kChamber, group++, {chamber.floor, 0.0, chamber.height}, {}, chamber.radii, {}});
  for (const Hall& hall : plan.halls)
    add({Shape::kHall, group++, {hall.floor, 0.0, hall.height}, {}, hall.size / 2.0, {}});
}

void RockField::add(Space space) {
  const bool is_segment = space.shape == Shape::kSegment;
  const Station& other = is_segment ? space.b : space.a;
  const double half_x = is_segment ? std::max(space.a.width, space.b.width) / 2 : space.half.x();
  const double half_y = is_segment ? half_x : space.half.y();
  space.reach.min = space.a.floor.cwiseMin(other.floor) - Eigen::Vector3d(half_x, half_y, 0.0);
  space.reach.max = space.a.floor.cwiseMax(other.floor) +
                    Eigen::Vector3d(half_x, half_y, std::max(space.a.height, other.height));
  const Eigen::Vector3d margin =
      Eigen::Vector3d::Constant(roughness_m_ + blend_m_ / 4.0 + 2.0 * cell_m_);
  space.reach.min -= margin + Eigen::Vector3d(0.0, 0.0, deepest_pit_m_);
  space.reach.max += margin;
  spaces_.push_back(space);
}

AxisAlignedBox RockField::bounds() const {
  AxisAlignedBox box = spaces_.front().reach;
  for (const Space& space : spaces_) box = hull(box, space.reach);
  return box;
}

RockField::Selection RockField::select(const AxisAlignedBox& region) const {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(blend_m_);
  const AxisAlignedBox near{region.min - margin, region.max + margin};
  Selection selection;
  bool touches = false;
  for (std::size_t i = 0; i < spaces_.size(); ++i) {
    if (intersection(spaces_[i].reach, near).isEmpty()) continue;
    touches = touches || !intersection(spaces_[i].reach, region).isEmpty();
    selection.spaces.push_back(i);
  }
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    if (!intersection(boxOf(blocks_[i]), near).isEmpty()) selection.blocks.push_back(i);
  for (std::size_t i = 0; i < pits_.size(); ++i)
    if (!intersection(boxOf(pits_[i]), near).isEmpty()) selection.pits.push_back(i);
  return touches ? selection : Selection{};
}

RockField::Sample RockField::sampleSegment(const Space& space, const Eigen::Vector3d& point) {
  const Eigen::Vector2d axis = (space.b.floor - space.a.floor).head<2>();
  const Eigen::Vector2d from_a = (point - space.a.floor).head<2>();
  const double length2 = axis.dot(axis);
  const double t = length2 > 0.0 ? std::clamp(from_a.dot(axis) / length2, 0.0, 1.0) : 0.0;
  const double lateral = std::sqrt((from_a - t * axis).squaredNorm());
  const double half_width = mix(space.a.width, space.b.width, t) / 2.0;
  const double height = mix(space.a.height, space.b.height, t);
  const double floor = mix(space.a.floor.z(), space.b.floor.z(), t);
  const double arch = 0.7 * std::min(half_width, height / 2.0);
  const double above = roundedCorner(lateral - half_width, point.z() - floor - height, arch);
  return {std::max(above, floor - space.root_m - point.z()), floor};
}

RockField::Sample RockField::sampleChamber(const Space& space, const Eigen::Vector3d& point) {
  const double middle = 0.25 * space.a.height;  // The dome's widest level above its floor.
  const Eigen::Vector3d radii(space.half.x(), space.half.y(), space.a.height - middle);
  const Eigen::Vector3d p = point - space.a.floor - Eigen::Vector3d(0.0, 0.0, middle);
  const Eigen::Vector3d scaled = p.cwiseQuotient(radii);
  const double k0 = std::sqrt(scaled.squaredNorm());
  const double k1 = std::sqrt(scaled.cwiseQuotient(radii).squaredNorm());
  const double distance = k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -radii.minCoeff();
  return {distance, space.a.floor.z()};
}

RockField::Sample RockField::sampleHall(const Space& space, const Eigen::Vector3d& point) {
  constexpr double kEdgeRadius = 0.3;
  const Eigen::Vector2d q = (point - space.a.floor).head<2>().cwiseAbs() - space.half;
  const double walls = roundedCorner(q.x(), q.y(), kEdgeRadius);
  const double floor = space.a.floor.z();
  const double above = roundedCorner(walls, point.z() - floor - space.a.height, kEdgeRadius);
  return {std::max(above, floor - space.root_m - point.z()), floor};
}

RockField::Sample RockField::sample(const Space& space, const Eigen::Vector3d& point) {
  switch (space.shape) {
    case Shape::kSegment:
      return sampleSegment(space, point);
    case Shape::kChamber:
      return sampleChamber(space, point);
    case Shape::kHall:
      return sampleHall(space, point);
  }
  return {kRock, 0.0};
}

RockField::Sample RockField::blended(const Eigen::Vector3d& point,
                                     const Selection& selection) const {
  Sample total{kRock, 0.0};
  for (std::size_t i = 0; i < selection.spaces.size();) {
    const int group = spaces_[selection.spaces[i]].group;
    Sample next{kRock, 0.0};
    for (; i < selection.spaces.size() && spaces_[selection.spaces[i]].group == group; ++i) {
      const Sample candidate = sample(spaces_[selection.spaces[i]], point);
      if (candidate.body < next.body) next = candidate;
    }
    const double share = std::clamp(0.5 + 0.5 * (total.body - next.body) / blend_m_, 0.0, 1.0);
    total.body = mix(total.body, next.body, share) - blend_m_ * share * (1.0 - share);
    total.floor = mix(total.floor, next.floor, share);
  }
  return total;
}

double RockField::roughness(const Eigen::Vector3d& point, double above_floor) const {
  if (roughness_m_ <= 0.0) return 0.0;
  const auto octave = [&](double wavelength_m, std::uint64_t seed) {
    const double noise = rockNoise(point, std::max(wavelength_m, 2.5 * cell_m_), seed);
    return std::clamp(0.5 + kContrast * (noise - 0.5), 0.0, 1.0);
  };
  const double coarse = octave(grain_m_, seed_);
  const double fine = octave(0.4 * grain_m_, seed_ + 1);
  const double wall_share = std::clamp(above_floor / 0.8, 0.0, 1.0);
  return roughness_m_ * mix(0.25, 1.0, wall_share) * (0.7 * coarse + 0.3 * fine);
}

double RockField::withFloorFeatures(double value, const Eigen::Vector3d& point,
                                    const Selection& selection) const {
  for (const std::size_t i : selection.pits)
    value = std::min(value, distanceTo(boxOf(pits_[i]), point));
  for (const std::size_t i : selection.blocks)
    value = std::max(value, -distanceTo(boxOf(blocks_[i]), point));
  return value;
}

double RockField::at(const Eigen::Vector3d& point, const Selection& selection) const {
  const Sample free = blended(point, selection);
  double value = withFloorFeatures(std::max(free.body, free.floor - point.z()), point, selection);
  for (const Pillar& pillar : pillars_) {
    constexpr double kEdgeRadius = 0.3;
    const Eigen::Vector2d q = (point.head<2>() - pillar.centre).cwiseAbs() - pillar.size / 2.0;
    value = std::max(value, -roundedCorner(q.x(), q.y(), kEdgeRadius));
  }
  if (value > roughness_m_ + cell_m_) return value;
  return value - roughness(point, point.z() - free.floor);
}

double RockField::at(const Eigen::Vector3d& point) const {
  return at(point, select({point, point}));
}

}  // namespace spelunk::sim
