#pragma once

#include <Eigen/Core>
#include <array>
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

  /// A ray from the sensor to `end` (relative to it, finite). Rays that do not go down are left
  /// out.
  void add(const Eigen::Vector3f& end) {
    batch_.x[batched_] = end.x();
    batch_.y[batched_] = end.y();
    batch_.z[batched_] = end.z();
    if (++batched_ == kBatch) enterBatch();
  }

  /// To be called after the last add and before what follows.
  void finish();

  /// Places at (first.x + i * step, first.y + j * step), relative to the sensor, i and j < side.
  struct Places {
    Eigen::Vector2f first;
    float step;
    int side;
  };
  /// From `begin` to before `end`; empty unless begin < end.
  struct Range {
    int begin;
    int end;
  };
  /// Of each row j the i outside of which no ray passes over a place to end beyond its ring.
  [[nodiscard]] std::vector<Range> reachOf(const Places& places) const;

  /// Places of a row, by i.
  struct Row {
    std::vector<float> distance;
    std::vector<std::uint32_t> index;  ///< Of the sector and ring.
  };
  /// Fills `row` for the places in `range` of the row at y, relative to the sensor.
  void locate(const Places& places, float y, Range range, Row& row) const;

  /// How much the steepest ray falls a metre that passes over the ring of place i and ends beyond
  /// it; 0 if none does.
  [[nodiscard]] float steepestBeyond(const Row& row, std::size_t i) const {
    return steepest_[row.index[i]];
  }

 private:
  static constexpr std::size_t kBatch = 256;
  static constexpr std::size_t kGroups = 64;  // of neighbouring sectors
  struct Batch {
    std::array<float, kBatch> x;
    std::array<float, kBatch> y;
    std::array<float, kBatch> z;
  };
  void enterBatch();

  float rings_per_m_;
  int rings_;
  std::vector<float> steepest_;             ///< By ring * sectors + sector.
  std::array<int, kGroups> farthest_ring_;  ///< In which a ray ends, by group of sectors.
  Batch batch_;                             ///< Ends to be entered together: the first so many.
  std::size_t batched_ = 0;
};

}  // namespace spelunk::terrain
