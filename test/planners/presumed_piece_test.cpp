#include "spelunk/planners/gbplanner/presumed_piece.h"

#include <gtest/gtest.h>

#include "spelunk/map/occupancy_map.h"

namespace spelunk::planners::gbplanner {
namespace {

using graph::VertexId;

/// A straight gallery of 40 m that was seen open, and a target near its end.
class AGalleryToATarget : public testing::Test {
 protected:
  AGalleryToATarget() {
    map::OccupancyMap map{map::MapParams{}};
    map.markFree({{0.0, -2.0, 0.0}, {40.0, 2.0, 3.0}});
    ways_ = std::make_unique<map::PresumedWays>(map.freeze(), Eigen::Vector3d(38.0, 0.0, 1.5),
                                                kPresumedReach_m);
    local_.root = add(2.0, 0.0);
  }
  VertexId add(double x, double y) { return local_.graph.addVertex({x, y, 1.5}); }
  void join(VertexId a, VertexId b, double weight_m) { local_.graph.addEdge(a, b, weight_m); }
  [[nodiscard]] Eigen::Vector3d at(VertexId id) const { return local_.graph.position(id); }

  LocalGraph local_;
  std::unique_ptr<map::PresumedWays> ways_;
  TriedTargets tried_{1.0};
};

TEST_F(AGalleryToATarget, GoesAsFarAlongItAsTheGraphDoes) {
  const VertexId middle = add(7.0, 0.0);
  const VertexId far = add(12.0, 0.0);
  join(local_.root, middle, 5.0);
  join(middle, far, 5.0);
  const graph::Polyline piece = pieceTowards(local_, *ways_, tried_);
  ASSERT_EQ(piece.size(), 3U);
  EXPECT_EQ(piece[0], at(local_.root));
  EXPECT_EQ(piece[1], at(middle));
  EXPECT_EQ(piece[2], at(far));
}

TEST_F(AGalleryToATarget, DoesNotPayForALongWayThatGetsLittleNearer) {
  const VertexId near = add(10.0, 0.0);
  const VertexId far = add(13.0, 0.0);
  join(local_.root, near, 8.0);
  join(near, far, 10.0);  // 3 m nearer for 10 m of way: worth less than half a metre a metre
  EXPECT_EQ(pieceTowards(local_, *ways_, tried_).back(), at(near));
}

TEST_F(AGalleryToATarget, TakesNoStepThatIsNoProgress) {
  join(local_.root, add(3.0, 0.0), 1.0);
  EXPECT_TRUE(pieceTowards(local_, *ways_, tried_).empty());
}

TEST_F(AGalleryToATarget, LeavesOutWhatFailedAndWhatIsNotJoined) {
  const VertexId middle = add(8.0, 0.0);
  const VertexId far = add(14.0, 0.0);
  add(20.0, 0.0);  // no edge leads there
  join(local_.root, middle, 6.0);
  join(middle, far, 6.0);
  ASSERT_EQ(pieceTowards(local_, *ways_, tried_).back(), at(far));
  tried_.giveUp(at(far), "looked at in vain");
  EXPECT_EQ(pieceTowards(local_, *ways_, tried_).back(), at(middle));
}

}  // namespace
}  // namespace spelunk::planners::gbplanner
