#include "spelunk/map/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "map_worlds.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

double plainClearance(const LocalWindow& window, const VoxelIndex& from, double limit_m) {
  const int reach = static_cast<int>(std::ceil(limit_m / window.resolution()));
  double nearest = limit_m;
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (window.at(VoxelIndex(from + VoxelIndex(x, y, z))) == Occupancy::kOccupied)
          nearest =
              std::min(nearest, VoxelIndex(x, y, z).cast<double>().norm() * window.resolution());
  return nearest;
}

class Clearance : public testing::TestWithParam<double> {};

TEST_P(Clearance, EqualsSearchingAllVoxelsAround) {
  OccupancyMap map = hallMap(MapParams{}, 3, 150, 5);
  const LocalWindow window(*map.freeze(), {{-6.0, -4.0, -1.0}, {3.0, 4.0, 3.0}});
  const ClearanceField field(window, GetParam());
  Rng rng(6);
  int limited = 0;
  for (int i = 0; i < 400; ++i) {
    const VoxelIndex local(rng.below(window.size().x()), rng.below(window.size().y()),
                           rng.below(window.size().z()));
    const VoxelIndex index = window.origin() + local;
    const double wanted = plainClearance(window, index, GetParam());
    ASSERT_NEAR(field.at(window.centreOf(index)), wanted, 1e-6);
    limited += wanted == GetParam() ? 1 : 0;
  }
  EXPECT_LT(limited, 400);
}

INSTANTIATE_TEST_SUITE_P(Limits, Clearance, testing::Values(0.05, 0.5, 1.1, 2.0));

TEST(Clearance, FarLimitsNeedWiderNumbers) {
  MapParams params;
  params.resolution_m = 0.05;
  params.range_min_m = 0.0;
  OccupancyMap map(params);
  occupy(map, {0, 0, 0});
  const LocalWindow window(*map.freeze(), {{0.0, 0.0, 0.0}, {7.0, 5.0, 0.1}});
  const ClearanceField field(window, 8.0);
  EXPECT_NEAR(field.at(window.centreOf({120, 80, 0})), std::hypot(6.0, 4.0), 1e-5);
}

TEST(Clearance, IsTheLimitOutsideAndWhereNothingIsOccupied) {
  OccupancyMap map{MapParams{}};
  const LocalWindow window(*map.freeze(), {{0.0, 0.0, 0.0}, {2.0, 2.0, 2.0}});
  const ClearanceField field(window, 1.5);
  EXPECT_DOUBLE_EQ(field.at({1.0, 1.0, 1.0}), 1.5);
  EXPECT_DOUBLE_EQ(field.at({9.0, 1.0, 1.0}), 1.5);
  EXPECT_DOUBLE_EQ(field.limit(), 1.5);
  EXPECT_THROW(ClearanceField(window, 0.0), Precondition);
}

}  // namespace
}  // namespace spelunk::map
