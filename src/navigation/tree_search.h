#pragma once

#include <functional>
#include <vector>

#include "spelunk/navigation/navigator.h"

namespace spelunk::navigation {

/// Which trees grow.
enum class TreeKind {
  kConnect,  ///< RRT-Connect: two trees, until they meet.
  kStar      ///< RRT*: one tree, rewired until the iterations are used up; the shortest way counts.
};

/// What becomes of the line that trees make.
enum class TreeLine { kAsFound, kSimplified };

/// What one search is to do.
struct TreeTask {
  TreeKind kind = TreeKind::kConnect;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();
  AxisAlignedBox region;  ///< Finite; holds start and goal.
  std::function<Eigen::Vector3d(Rng&)> draw;
  /// Whether the robot may go straight from one place to another.
  std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)> is_free;
  double extension_m = 1.0;  ///< Longest step of RRT-Connect; RRT* takes four times this.
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

/// RRT-Connect (Kuffner and LaValle, ICRA 2000) or RRT* (Karaman and Frazzoli, Sampling-based
/// algorithms for optimal motion planning, IJRR 2011) as OMPL has them, with our draws and checks;
/// the same task and stream give the same result.
[[nodiscard]] TreeResult growTrees(const TreeTask& task, Rng rng);

}  // namespace spelunk::navigation
