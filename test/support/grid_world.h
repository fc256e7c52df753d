#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/pose.h"
#include "spelunk/common/rng.h"
#include "spelunk/common/scan.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/map/occupancy_map.h"

namespace spelunk::test {

/// A world of solid and empty cells: cheap enough for hundreds of missions. Solid outside.
class GridWorld {
 public:
  GridWorld(const Eigen::Vector3i& size, double cell_m)
      : size_(size), cell_m_(cell_m), solid_(static_cast<std::size_t>(size.prod()), 1) {}

  void carve(const AxisAlignedBox& box) { fill(box, 0); }
  void block(const AxisAlignedBox& box) { fill(box, 1); }

  [[nodiscard]] double cell() const { return cell_m_; }
  [[nodiscard]] AxisAlignedBox bounds() const {
    return {Eigen::Vector3d::Zero(), cell_m_ * size_.cast<double>()};
  }
  [[nodiscard]] bool isSolid(const Eigen::Vector3i& index) const {
    if ((index.array() < 0).any() || (index.array() >= size_.array()).any()) return true;
    return solid_[offset(index)] != 0;
  }
  [[nodiscard]] Eigen::Vector3i indexOf(const Eigen::Vector3d& point) const {
    return (point / cell_m_).array().floor().cast<int>();
  }

  /// Whether a box meets a solid cell.
  [[nodiscard]] bool collides(const AxisAlignedBox& box) const {
    const Eigen::Vector3i low = indexOf(box.min);
    const Eigen::Vector3i high = indexOf(box.max);
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x)
          if (isSolid({x, y, z})) return true;
    return false;
  }

  /// Distance along a unit direction to the first solid cell, at most `limit_m`.
  [[nodiscard]] double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                            double limit_m) const {
    Eigen::Vector3i index = indexOf(origin);
    Eigen::Vector3d next;
    Eigen::Vector3d step;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = direction[axis];
      step[axis] =
          std::abs(d) < 1e-12 ? std::numeric_limits<double>::infinity() : cell_m_ / std::abs(d);
      const double edge = cell_m_ * (index[axis] + (d > 0.0 ? 1 : 0));
      next[axis] =
          std::abs(d) < 1e-12 ? std::numeric_limits<double>::infinity() : (edge - origin[axis]) / d;
    }
    for (double t = 0.0; t < limit_m;) {
      if (isSolid(index)) return t;
      int axis = 0;
      t = next.minCoeff(&axis);
      index[axis] += direction[axis] > 0.0 ? 1 : -1;
      next[axis] += step[axis];
    }
    return limit_m;
  }

  /// What a sensor at a robot's pose returns; misses come back at its full range.
  [[nodiscard]] Scan scan(const SensorModel& sensor, const Pose& pose, double stamp_s) const {
    Scan scan;
    scan.stamp_s = stamp_s;
    scan.sensor = sensor.name;
    scan.T_world_sensor = T_world_base(pose) * T_base_sensor(sensor);
    for (const Eigen::Vector3f& direction : rayDirections(sensor)) {
      const Eigen::Vector3d world = scan.T_world_sensor.linear() * direction.cast<double>();
      const double range = cast(scan.T_world_sensor.translation(), world, sensor.range_max_m);
      scan.points.push_back(direction * static_cast<float>(range + 0.02));
    }
    return scan;
  }

  /// Enters everything into a map at once: cells as they are, nothing left unknown.
  void enterInto(map::OccupancyMap& map) const {
    enterRock(map);
    map.markFree({bounds().min.array() + 1e-6, bounds().max.array() - 1e-6});
  }

  /// Enters the solid cells alone; all air stays unknown.
  void enterRock(map::OccupancyMap& map) const {
    const double r = map.params().resolution_m;
    const Eigen::Vector3d low = Eigen::Vector3d::Constant(0.5 * r);
    for (double z = low.z(); z < bounds().max.z(); z += r)
      for (double y = low.y(); y < bounds().max.y(); y += r)
        for (double x = low.x(); x < bounds().max.x(); x += r) {
          const Eigen::Vector3d centre(x, y, z);
          if (!isSolid(indexOf(centre))) continue;
          Scan hit;
          hit.T_world_sensor.translation() = centre;
          hit.points.emplace_back(0.01F, 0.0F, 0.0F);
          map.insert(hit, {centre.array() + 10.0, centre.array() + 9.0});
        }
  }

 private:
  [[nodiscard]] std::size_t offset(const Eigen::Vector3i& index) const {
    return static_cast<std::size_t>((index.z() * size_.y() + index.y()) * size_.x() + index.x());
  }
  void fill(const AxisAlignedBox& box, char value) {
    const Eigen::Vector3i low = indexOf(box.min.array() + 1e-9).cwiseMax(0);
    const Eigen::Vector3i high =
        indexOf(box.max.array() - 1e-9).cwiseMin(size_ - Eigen::Vector3i::Ones());
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) solid_[offset({x, y, z})] = value;
  }

  Eigen::Vector3i size_;
  double cell_m_;
  std::vector<char> solid_;
};

/// Rooms and corridors 3 m high, carved at random around the middle (16, 16, 2) of a 32 x 32 m
/// plan.
inline GridWorld randomMine(Rng rng) {
  GridWorld world({64, 64, 10}, 0.5);
  Eigen::Vector2d at(16.0, 16.0);
  world.carve({{13.5, 13.5, 0.5}, {18.5, 18.5, 3.5}});
  for (int leg = 0; leg < 10; ++leg) {
    const int axis = rng.below(2);
    const double half = 0.5 * (2.0 + 0.5 * rng.below(5));
    Eigen::Vector2d to = at;
    to[axis] = std::clamp(to[axis] + rng.uniform(-12.0, 12.0), 4.0, 28.0);
    const Eigen::Vector2d low = at.cwiseMin(to).array() - half;
    const Eigen::Vector2d high = at.cwiseMax(to).array() + half;
    world.carve({{low.x(), low.y(), 0.5}, {high.x(), high.y(), 3.5}});
    at = rng.below(3) == 0 ? Eigen::Vector2d(16.0, 16.0) : to;
  }
  return world;
}

/// A straight corridor along x, 3 m wide and high, with air from x = 1 to length - 1, y 1..4,
/// z 1..4.
inline GridWorld corridorWorld(double length_m) {
  GridWorld world({static_cast<int>(length_m / 0.5), 10, 10}, 0.5);
  world.carve({{1.0, 1.0, 1.0}, {length_m - 1.0, 4.0, 4.0}});
  return world;
}

}  // namespace spelunk::test
