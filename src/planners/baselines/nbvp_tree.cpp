#include "spelunk/planners/baselines/nbvp_tree.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::planners::baselines {

NbvpTree::NbvpTree(const Pose& root, double distance_weight) : distance_weight_(distance_weight) {
  nodes_.push_back({root, 0, 0.0, 0.0, 0.0});
  index_.add(root.position);
}

std::size_t NbvpTree::add(std::size_t parent, const Pose& pose, double visible_m3) {
  require(parent < nodes_.size(), "NbvpTree: no such parent");
  require(visible_m3 >= 0.0, "NbvpTree: a negative volume");
  const NbvpNode& before = nodes_[parent];
  const double length = before.length_m + distance(before.pose, pose);
  const double gain = before.gain_m3 + visible_m3 * std::exp(-distance_weight_ * length);
  nodes_.push_back({pose, parent, length, visible_m3, gain});
  index_.add(pose.position);
  return nodes_.size() - 1;
}

std::size_t NbvpTree::nearestTo(const Eigen::Vector3d& point) const {
  return *index_.findNearest(point);
}

std::vector<std::size_t> NbvpTree::branchTo(std::size_t number) const {
  std::vector<std::size_t> branch{number};
  while (branch.back() != 0) branch.push_back(nodes_[branch.back()].parent);
  std::reverse(branch.begin(), branch.end());
  return branch;
}

}  // namespace spelunk::planners::baselines
