#include "terrain/ray_fan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/rng.h"

namespace spelunk::terrain {
namespace {

constexpr double kRing_m = 0.04;
constexpr double kReach_m = 6.0;

/// Ends of rays in a few wedges around the sensor, some of them above it.
std::vector<Eigen::Vector3f> endsOfRays(Rng& rng, int wedges) {
  std::vector<Eigen::Vector3f> ends;
  for (int wedge = 0; wedge < wedges; ++wedge) {
    const double middle = rng.uniform(-M_PI, M_PI);
    const double width = rng.uniform(0.0, 1.0);
    const double farthest = rng.uniform(0.1, 9.0);
    for (int i = 0; i < 300; ++i) {
      const double angle = middle + rng.uniform(-width, width);
      const double distance = rng.uniform(0.0, farthest);
      ends.push_back(Eigen::Vector3d(distance * std::cos(angle), distance * std::sin(angle),
                                     rng.uniform(-1.0, 0.1))
                         .cast<float>());
    }
  }
  ends.emplace_back(0.0F, 0.0F, -1.0F);  // straight down: no direction
  return ends;
}

int ringOf(const Eigen::Vector3f& place) {
  const float distance = std::sqrt(place.x() * place.x() + place.y() * place.y());
  const auto rings = static_cast<float>(static_cast<int>(kReach_m / kRing_m) + 1);
  return static_cast<int>(std::min(distance * static_cast<float>(1.0 / kRing_m), rings));
}

int sectorOf(const Eigen::Vector3f& place) {
  const float sum = std::max(std::fabs(place.x()) + std::fabs(place.y()), 1e-6F);
  const float x = place.x() / sum;
  return std::min(static_cast<int>((place.y() >= 0.0F ? 1.0F - x : 3.0F + x) * 128.0F), 511);
}

/// One ray after the other.
float steepestPlainly(const std::vector<Eigen::Vector3f>& ends, const Eigen::Vector3f& place) {
  float steepest = 0.0F;
  for (const Eigen::Vector3f& end : ends) {
    const float distance = std::sqrt(end.x() * end.x() + end.y() * end.y());
    if (end.z() >= 0.0F || distance == 0.0F || sectorOf(end) != sectorOf(place)) continue;
    if (ringOf(end) > ringOf(place)) steepest = std::max(steepest, -end.z() / distance);
  }
  return steepest;
}

TEST(RayFan, FindsTheSteepestRayBeyondEveryPlaceAndNoneOutOfReach) {
  Rng rng(3);
  RayFan fan(kRing_m, kReach_m);
  int passed = 0;
  int out_of_reach = 0;
  for (int scan = 0; scan < 12; ++scan) {
    const std::vector<Eigen::Vector3f> ends = endsOfRays(rng, scan % 4);
    fan.clear();
    for (const Eigen::Vector3f& end : ends) fan.add(end);
    fan.finish();
    const auto offset = static_cast<float>(rng.uniform(0.0, 1.0));
    const RayFan::Places places{{-3.7F - offset, -4.3F + offset}, 0.07F, 115};
    const std::vector<RayFan::Range> reach = fan.reachOf(places);
    RayFan::Row row{std::vector<float>(115), std::vector<std::uint32_t>(115)};
    for (int j = 0; j < places.side; ++j) {
      const float y = places.first.y() + static_cast<float>(j) * places.step;
      const RayFan::Range& range = reach[static_cast<std::size_t>(j)];
      ASSERT_TRUE(range.begin >= range.end || (range.begin >= 0 && range.end <= places.side));
      fan.locate(places, y, range, row);
      for (int i = 0; i < places.side; ++i) {
        const float x = places.first.x() + static_cast<float>(i) * places.step;
        const float expected = steepestPlainly(ends, {x, y, 0.0F});
        const bool is_in_reach = i >= range.begin && i < range.end;
        out_of_reach += is_in_reach ? 0 : 1;
        passed += expected > 0.0F ? 1 : 0;
        EXPECT_EQ(is_in_reach ? fan.steepestBeyond(row, static_cast<std::size_t>(i)) : 0.0F,
                  expected)
            << scan << ": " << x << " " << y;
      }
    }
  }
  EXPECT_GT(passed, 10000);
  EXPECT_GT(out_of_reach, 40000);
}

}  // namespace
}  // namespace spelunk::terrain
