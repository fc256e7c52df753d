#pragma once

#include <cstddef>
#include <vector>

#include "spelunk/common/pose.h"
#include "spelunk/graph/point_index.h"

namespace spelunk::planners::baselines {

/// One configuration of the tree.
struct NbvpNode {
  Pose pose;
  std::size_t parent = 0;  ///< Of the root: itself.
  double length_m = 0.0;   ///< Of the branch from the root.
  double visible_m3 = 0.0;
  double gain_m3 = 0.0;  ///< Of the branch.
};

/// The random tree of Bircher 2016, Algorithm 1, with the gains of its branches. Node 0 is the
/// root, which gains nothing.
class NbvpTree {
 public:
  /// `distance_weight`: lambda, 1/m.
  NbvpTree(const Pose& root, double distance_weight);

  /// Adds a node and gives its number. Its gain is that of its parent plus
  /// visible * exp(-lambda * c), c the length of the branch from the root. Throws Precondition if
  /// there is no such parent or the volume is negative.
  std::size_t add(std::size_t parent, const Pose& pose, double visible_m3);

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] const NbvpNode& node(std::size_t number) const { return nodes_[number]; }
  [[nodiscard]] std::size_t nearestTo(const Eigen::Vector3d& point) const;

  /// The nodes from the root to `number`, both included.
  [[nodiscard]] std::vector<std::size_t> branchTo(std::size_t number) const;

 private:
  double distance_weight_;
  std::vector<NbvpNode> nodes_;
  graph::PointIndex index_;
};

}  // namespace spelunk::planners::baselines
