#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "spelunk/evaluation/grid_shape.h"
#include "spelunk/evaluation/reachable_volume.h"

namespace spelunk::evaluation {

/// The reachable space in coarser voxels, each with the reachable volume in it.
class TargetVoxels {
 public:
  TargetVoxels(const ReachableSpace& space, double edge_m);

  [[nodiscard]] double edge() const { return edge_m_; }
  [[nodiscard]] std::size_t size() const { return centres_.size(); }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& centres() const { return centres_; }
  [[nodiscard]] const std::vector<double>& volumes_m3() const { return volumes_m3_; }

  /// The voxel around a point; none where there is nothing to reach.
  [[nodiscard]] std::optional<std::size_t> find(const Eigen::Vector3d& point) const;

 private:
  [[nodiscard]] Eigen::Vector3i cellOf(const Eigen::Vector3d& point) const;

  double edge_m_;
  Eigen::Vector3i first_ = Eigen::Vector3i::Zero();
  GridShape shape_;
  std::vector<std::int32_t> numbers_;  ///< Of the voxels; -1: nothing there.
  std::vector<Eigen::Vector3d> centres_;
  std::vector<double> volumes_m3_;
};

}  // namespace spelunk::evaluation
