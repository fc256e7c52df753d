#include "spelunk/navigation/path_shortening.h"

#include <gtest/gtest.h>

#include "support/grid_world.h"

namespace spelunk::navigation {
namespace {

const Eigen::Vector3d kBox(0.8, 0.8, 0.4);

std::shared_ptr<const map::FrozenMap> corridor() {
  map::MapParams params;
  params.resolution_m = 0.25;
  params.range_min_m = 0.0;
  map::OccupancyMap map(params);
  test::corridorWorld(30.0).enterInto(map);
  return map.freeze();
}

Path zigzag() {
  Path path;
  for (int k = 0; k <= 40; ++k)
    path.push_back({{3.0 + 0.5 * k, 2.5 + (k % 2 == 0 ? 0.3 : -0.3), 2.5}, 0.0});
  return path;
}

TEST(PathShortening, TakesTheZigzagOutOfAFreeCorridor) {
  map::ConfigurationSpace space(kBox, corridor());
  const Path path = zigzag();
  const Path shorter = shortened(path, space, 6.0);
  EXPECT_EQ(shorter.front().position, path.front().position);
  EXPECT_EQ(shorter.back().position, path.back().position);
  EXPECT_LT(shorter.size(), 8U);
  EXPECT_LT(lengthOf(shorter), 0.9 * lengthOf(path));
  for (std::size_t i = 1; i < shorter.size(); ++i)
    EXPECT_TRUE(space.isSweepFree(shorter[i - 1].position, shorter[i].position));
}

TEST(PathShortening, KeepsWhatCannotBeShortened) {
  map::OccupancyMap unknown(map::MapParams{});
  map::ConfigurationSpace space(kBox, unknown.freeze());
  const Path path = zigzag();
  EXPECT_EQ(shortened(path, space, 6.0).size(), path.size());
  EXPECT_EQ(shortened({path.front()}, space, 6.0).size(), 1U);
}

}  // namespace
}  // namespace spelunk::navigation
