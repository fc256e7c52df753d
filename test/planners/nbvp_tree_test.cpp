#include "spelunk/planners/baselines/nbvp_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"

namespace spelunk::planners::baselines {
namespace {

struct Grown {
  NbvpTree tree;
  std::vector<double> visible;  ///< As it was added; 0 for the root.
};

/// A tree of 200 nodes with random parents, places and volumes.
Grown randomTree(double distance_weight) {
  Rng rng(11);
  Grown grown{NbvpTree({{1.0, 2.0, 3.0}, 0.5}, distance_weight), {0.0}};
  for (int i = 1; i < 200; ++i) {
    const Pose pose{{rng.uniform(-20, 20), rng.uniform(-20, 20), rng.uniform(0, 4)}, 0.0};
    grown.visible.push_back(rng.uniform(0.0, 500.0));
    grown.tree.add(static_cast<std::size_t>(rng.below(i)), pose, grown.visible.back());
  }
  return grown;
}

TEST(NbvpTree, GainsWhatItsBranchSeesEachDiscountedByTheWayFromTheRoot) {
  constexpr double kWeight = 0.07;
  const Grown grown = randomTree(kWeight);
  for (std::size_t leaf = 0; leaf < grown.tree.size(); ++leaf) {
    double length = 0.0;
    double gain = 0.0;
    Eigen::Vector3d last = grown.tree.node(0).pose.position;
    for (const std::size_t number : grown.tree.branchTo(leaf)) {
      const Eigen::Vector3d& here = grown.tree.node(number).pose.position;
      length += (here - last).norm();
      gain += grown.visible[number] * std::exp(-kWeight * length);
      last = here;
    }
    EXPECT_NEAR(grown.tree.node(leaf).length_m, length, 1e-9);
    EXPECT_NEAR(grown.tree.node(leaf).gain_m3, gain, 1e-9 * (1.0 + gain));
  }
}

TEST(NbvpTree, SumsVolumesWhenDistanceCostsNothing) {
  NbvpTree tree({}, 0.0);
  const std::size_t near = tree.add(0, {{5.0, 0.0, 0.0}, 0.0}, 10.0);
  const std::size_t far = tree.add(near, {{500.0, 0.0, 0.0}, 0.0}, 7.0);
  EXPECT_DOUBLE_EQ(tree.node(far).gain_m3, 17.0);
  EXPECT_DOUBLE_EQ(tree.node(0).gain_m3, 0.0);
}

TEST(NbvpTree, NamesABranchFromTheRootOn) {
  NbvpTree tree({}, 0.1);
  const std::size_t a = tree.add(0, {{1.0, 0.0, 0.0}, 0.0}, 0.0);
  const std::size_t beside = tree.add(0, {{0.0, 1.0, 0.0}, 0.0}, 0.0);
  const std::size_t b = tree.add(a, {{2.0, 0.0, 0.0}, 0.0}, 0.0);
  EXPECT_EQ(tree.branchTo(b), (std::vector<std::size_t>{0, a, b}));
  EXPECT_EQ(tree.branchTo(beside), (std::vector<std::size_t>{0, beside}));
  EXPECT_EQ(tree.branchTo(0), (std::vector<std::size_t>{0}));
}

TEST(NbvpTree, FindsTheNearestNodeAsLookingAtEachDoes) {
  const Grown grown = randomTree(0.1);
  Rng rng(12);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d point(rng.uniform(-25, 25), rng.uniform(-25, 25), rng.uniform(-1, 5));
    double nearest = 1e9;
    for (std::size_t i = 0; i < grown.tree.size(); ++i)
      nearest = std::min(nearest, (grown.tree.node(i).pose.position - point).norm());
    const std::size_t found = grown.tree.nearestTo(point);
    EXPECT_DOUBLE_EQ((grown.tree.node(found).pose.position - point).norm(), nearest);
  }
}

TEST(NbvpTree, RefusesAnUnknownParentAndANegativeVolume) {
  NbvpTree tree({}, 0.1);
  EXPECT_THROW(tree.add(1, {}, 0.0), Precondition);
  EXPECT_THROW(tree.add(0, {}, -1.0), Precondition);
}

}  // namespace
}  // namespace spelunk::planners::baselines
