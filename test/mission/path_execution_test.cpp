#include "spelunk/mission/path_execution.h"

#include <gtest/gtest.h>

#include "spelunk/navigation/trajectory_timing.h"

namespace spelunk::mission {
namespace {

PathExecution straight() {
  const Path path{{{0.0, 0.0, 1.0}, 0.0}, {{10.0, 0.0, 1.0}, 0.0}};
  return {path,
          navigation::timed(path, {2.0, 2.0, 1.0, 2.0}, {5.0, Eigen::Vector3d::Zero(), 0.0}),
          planners::PathKind::kLocal,
          {0.8, 0.8, 0.4},
          0.25};
}

TEST(PathExecution, ArcGrowsWithTimeUpToLength) {
  const PathExecution execution = straight();
  EXPECT_NEAR(execution.length(), 10.0, 1e-6);
  EXPECT_DOUBLE_EQ(execution.arcAt(0.0), 0.0);
  double last = 0.0;
  for (double t = 5.0; t < execution.endTime(); t += 0.03) {
    const double arc = execution.arcAt(t);
    EXPECT_GE(arc, last - 1e-9);
    EXPECT_NEAR(arc, execution.reference(t).pose.position.x(), 0.02);
    last = arc;
  }
  EXPECT_NEAR(execution.arcAt(execution.endTime() + 1.0), 10.0, 1e-6);
}

TEST(PathExecution, NotesNearestBlockAheadOnly) {
  PathExecution execution = straight();
  execution.noteOccupied({map::VoxelIndex(32, 0, 4), map::VoxelIndex(24, 0, 4)}, 5.0);
  ASSERT_TRUE(execution.blockedAt());
  EXPECT_NEAR(*execution.blockedAt(), 6.0 - 0.4, 0.05);
  execution.clearBlock();
  execution.noteOccupied({map::VoxelIndex(4, 0, 4)}, execution.endTime());
  EXPECT_FALSE(execution.blockedAt());
}

TEST(PathExecution, VoxelBesideTheSweepIsNoBlock) {
  PathExecution execution = straight();
  execution.noteOccupied({map::VoxelIndex(24, 2, 4)}, 5.0);
  EXPECT_FALSE(execution.blockedAt());
}

TEST(PathExecution, NearestArcIsThatOfThePlaceBeside) {
  const PathExecution execution = straight();
  EXPECT_NEAR(execution.nearestArc({4.2, 0.7, 1.1}, 0.0, 10.0), 4.2, 1e-6);
  EXPECT_NEAR(execution.nearestArc({-3.0, 0.0, 1.0}, 0.0, 10.0), 0.0, 1e-6);
  EXPECT_NEAR(execution.nearestArc({12.0, 0.0, 1.0}, 0.0, 10.0), 10.0, 1e-6);
  EXPECT_GT(execution.nearestArc({1.0, 0.0, 1.0}, 6.0, 10.0), 5.5);  // only looked at around there
}

}  // namespace
}  // namespace spelunk::mission
