#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "spelunk/common/path.h"
#include "spelunk/map/occupancy.h"

namespace spelunk::navigation {

/// Many straight sweeps of one box, indexed so that a voxel finds those that touch it at once.
class SweptIndex {
 public:
  /// `box`: full extents, metres. `resolution_m`: edge of the voxels that will be asked about.
  SweptIndex(const Eigen::Vector3d& box, double resolution_m);

  /// Adds the box moved straight from `a` to `b` under `id` (any number, several sweeps may share
  /// it).
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::uint32_t id);

  struct Hit {
    std::uint32_t id = 0;
    double along = 0.0;  ///< Share of the sweep, 0 at `a`, where the box first touches the voxel.
  };
  /// For voxel after voxel all sweeps whose box touches it, in the order they were added. Fastest
  /// where neighbours come one after the other.
  [[nodiscard]] std::vector<Hit> touching(const std::vector<map::VoxelIndex>& voxels) const;

 private:
  struct Sweep {
    Eigen::Vector3d a;
    Eigen::Vector3d b;
    double from = 0.0;  ///< This piece's part of the whole sweep.
    double to = 1.0;
    std::uint32_t id = 0;
  };
  void addPiece(const Sweep& sweep);
  void addTo(std::uint64_t cell, std::uint32_t number);
  [[nodiscard]] std::uint64_t cellOf(const Eigen::Vector3d& point) const;

  Eigen::Vector3d half_;  ///< Half extents of the box.
  double resolution_m_;
  std::vector<Sweep> sweeps_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>>
      cells_;  ///< Looked up, never walked.
  /// By a hash of the cell: 0 where no sweep can be. Most voxels are far from all, and this table
  /// stays in the processor's cache.
  std::bitset<1U << 16U> is_near_;
};

/// Tells whether voxels that became occupied lie in the sweep of a path, and where. Built once a
/// path; a question costs one hash look-up a voxel.
class PathMonitor {
 public:
  PathMonitor(const Path& path, const Eigen::Vector3d& box, double resolution_m);

  /// The arc length (metres from the path's begin) at which the box first touches one of `voxels`,
  /// touches that end before `from_m` left out; none if the rest of the path stays clear.
  [[nodiscard]] std::optional<double> firstHit(const std::vector<map::VoxelIndex>& voxels,
                                               double from_m = 0.0) const;

 private:
  SweptIndex index_;
  std::vector<double> arc_m_;  ///< At the begin of each segment, and of the end.
};

}  // namespace spelunk::navigation
