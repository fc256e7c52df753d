#include "spelunk/mission/endurance_guard.h"

#include <gtest/gtest.h>

namespace spelunk::mission {
namespace {

TEST(EnduranceGuard, LargerReserveCounts) {
  EnduranceGuard guard({20.0, 3.0, 1.25});
  guard.report(900.0);
  EXPECT_DOUBLE_EQ(guard.reserve(), 27.0);
  EnduranceGuard short_flight({20.0, 3.0, 1.25});
  short_flight.report(300.0);
  EXPECT_DOUBLE_EQ(short_flight.reserve(), 20.0);
}

TEST(EnduranceGuard, ReserveStaysWhileEnduranceFalls) {
  EnduranceGuard guard({0.0, 10.0, 1.0});
  guard.report(500.0);
  guard.report(100.0);
  EXPECT_DOUBLE_EQ(guard.reserve(), 50.0);
  EXPECT_DOUBLE_EQ(guard.remaining(), 100.0);
}

TEST(EnduranceGuard, MarginTakesWayHomePessimistically) {
  EnduranceGuard guard({20.0, 0.0, 1.5});
  guard.report(100.0);
  EXPECT_DOUBLE_EQ(guard.margin(40.0), 20.0);
  EXPECT_LT(guard.margin(60.0), 0.0);
  EXPECT_DOUBLE_EQ(guard.marginAfter(10.0, 40.0), 10.0);
}

TEST(EnduranceGuard, DisposableNeverPromisesMoreThanTheMarginRule) {
  EnduranceGuard guard({20.0, 0.0, 1.25});
  guard.report(120.0);
  const double disposable = guard.disposable(5.0);
  EXPECT_DOUBLE_EQ(disposable, 76.0);
  EXPECT_GE(guard.marginAfter(5.0, disposable), -1e-9);
  guard.report(10.0);
  EXPECT_DOUBLE_EQ(guard.disposable(0.0), 0.0);
}

}  // namespace
}  // namespace spelunk::mission
