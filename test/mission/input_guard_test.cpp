#include "spelunk/mission/input_guard.h"

#include <gtest/gtest.h>

#include <limits>

namespace spelunk::mission {
namespace {

RobotState at(double stamp_s, double x) {
  RobotState state;
  state.stamp_s = stamp_s;
  state.pose.position.x() = x;
  return state;
}

TEST(InputGuard, TakesSteadyMotion) {
  InputGuard guard(2.0);
  for (int k = 0; k < 50; ++k) EXPECT_FALSE(guard.check(at(0.1 * k, 0.2 * k)));
  EXPECT_DOUBLE_EQ(guard.latest()->pose.position.x(), 0.2 * 49);
}

TEST(InputGuard, NamesNotANumber) {
  InputGuard guard(2.0);
  RobotState state = at(0.0, std::numeric_limits<double>::quiet_NaN());
  ASSERT_TRUE(guard.check(state));
  EXPECT_NE(guard.check(state)->find("NaN"), std::string::npos);
  EXPECT_FALSE(guard.latest());
}

TEST(InputGuard, NamesBackwardStamp) {
  InputGuard guard(2.0);
  EXPECT_FALSE(guard.check(at(10.0, 0.0)));
  const auto fault = guard.check(at(9.0, 0.0));
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("back"), std::string::npos);
  EXPECT_DOUBLE_EQ(guard.latest()->stamp_s, 10.0);
}

TEST(InputGuard, RefusesJumpOfMetresAndKeepsOldPlace) {
  InputGuard guard(2.0);
  EXPECT_FALSE(guard.check(at(0.0, 0.0)));
  const auto fault = guard.check(at(0.1, 5.0));
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("5.00 m"), std::string::npos);
  EXPECT_DOUBLE_EQ(guard.latest()->pose.position.x(), 0.0);
}

TEST(InputGuard, BelievesNewPlaceOnceReportsAgree) {
  InputGuard guard(2.0);
  EXPECT_FALSE(guard.check(at(0.0, 0.0)));
  int refused = 0;
  double stamp = 0.1;
  while (guard.check(at(stamp, 8.0)) && refused < 100) {
    ++refused;
    stamp += 0.1;
  }
  EXPECT_GE(refused, 3);
  EXPECT_LE(refused, 10);
  EXPECT_DOUBLE_EQ(guard.latest()->pose.position.x(), 8.0);
}

}  // namespace
}  // namespace spelunk::mission
