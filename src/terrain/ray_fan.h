#pragma once

#include <Eigen/Core>
#include <cstdint>
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

  /// A row of places at the same y, relative to the sensor.
  struct Row {
    std::vector<float> distance;
    std::vector<std::uint32_t> index;  ///< Of the sector and ring.
  };
  /// Fills `row` for the places (x_first + i * x_step, y).
  void locate(float x_first, float x_step, float y, Row& row) const;

  /// How much the steepest ray falls a metre that passes over the ring of place i and ends beyond
  /// it; 0 if none does.
  [[nodiscard]] float steepestBeyond(const Row& row, std::size_t i) const {
    return steepest_[row.index[i]];
  }

 private:
  float rings_per_m_;
  int rings_;
  std::vector<float> steepest_;  ///< By ring * sectors + sector.
};

}  // namespace spelunk::terrain
