#pragma once

#include <cstdint>
#include <vector>

#include "scan_marks.h"
#include "spelunk/map/occupancy_map.h"

namespace spelunk::map {

/// Where the rays of a scan end, in the world frame and axis by axis.
struct ScanEnds {
  std::vector<float> point[3];         ///< Metres, as OctoMap rounds them.
  std::vector<std::int32_t> voxel[3];  ///< Around the point.
  std::size_t count = 0;               ///< Of ends; the vectors are longer.

  void makeRoomFor(std::size_t ends);
  void set(std::size_t i, const Eigen::Vector3f& end, const VoxelIndex& around);
  [[nodiscard]] Eigen::Vector3f pointAt(std::size_t i) const;
  [[nodiscard]] VoxelIndex voxelAt(std::size_t i) const;
};

/// Finds where the rays of scans end, for points that a map can use.
class ScanPoints {
 public:
  explicit ScanPoints(const MapParams& params);

  /// Replaces `ends` and marks the voxels around them as hit. With OctoMap's discretization a
  /// voxel is one end, at its centre, however many points lie in it. Counts in `update` what is
  /// dropped and why: see OccupancyMap::insert.
  void findEnds(const Scan& scan, const AxisAlignedBox& robot_body, ScanMarks& marks,
                ScanEnds& ends, MapUpdate& update) const;

 private:
  double resolution_m_;
  double range_min_m_;
  bool discretize_;
};

}  // namespace spelunk::map
