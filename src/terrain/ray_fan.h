#pragma once

#include <Eigen/Core>
#include <vector>

namespace spelunk::terrain {

/// The rays of one scan that go down, by the direction and distance of their ends: of each sector
/// and ring of the ground around the sensor, the steepest ray that goes on beyond the ring. Below
/// that ray lies whatever surface the ring's ground has. Keeps its memory from scan to scan.
class RayFan {
 public:
  /// Rings are `ring_m` wide and reach at least `reach_m`.
  RayFan(double ring_m, double reach_m);

  void clear();

  /// A ray from the sensor to `end` (relative to it). Rays that do not go down are left out.
  void add(const Eigen::Vector3f& end);

  /// To be called after the last add and before the first steepestBeyond.
  void finish();

  /// How much the steepest ray falls a metre that passes over the ring of a place (relative to the
  /// sensor) and ends beyond it; 0 if none does.
  [[nodiscard]] float steepestBeyond(const Eigen::Vector2f& place) const;

 private:
  [[nodiscard]] std::size_t indexOf(const Eigen::Vector2f& place, float distance) const;

  float rings_per_m_;
  int rings_;
  std::vector<float> steepest_;  ///< By sector * rings + ring.
};

}  // namespace spelunk::terrain
