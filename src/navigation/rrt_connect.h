#pragma once

#include <functional>
#include <vector>

#include "spelunk/navigation/navigator.h"

namespace spelunk::navigation {

/// What becomes of the line that two trees make.
enum class TreeLine { kAsFound, kSimplified };

/// What one run of RRT-Connect is to do.
struct TreeTask {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();
  AxisAlignedBox region;  ///< Finite; holds start and goal.
  std::function<Eigen::Vector3d(Rng&)> draw;
  /// Whether the robot may go straight from one place to another.
  std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)> is_free;
  double extension_m = 1.0;
  int iterations = 20000;
  double time_limit_s = 0.0;  ///< May be infinite.
  TreeLine line = TreeLine::kSimplified;
};

struct TreeResult {
  std::vector<Eigen::Vector3d> line;  ///< From start to goal; empty if none was found.
  int iterations = 0;
  NavigationTrees trees;
  std::vector<Eigen::Vector3d> reached;  ///< Vertices of the tree that grew from the start.
};

/// RRT-Connect as OMPL has it, with our draws and checks; the same task and stream give the same
/// result.
[[nodiscard]] TreeResult growTrees(const TreeTask& task, Rng rng);

}  // namespace spelunk::navigation
