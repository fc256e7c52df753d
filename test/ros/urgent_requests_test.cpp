#include "spelunk/ros/urgent_requests.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include "spelunk/common/stopwatch.h"

namespace spelunk::bridge {
namespace {

TEST(UrgentRequests, AreTakenOnce) {
  UrgentRequests urgent;
  EXPECT_FALSE(urgent.take());
  urgent.ask(Urgent::kHome);
  EXPECT_FALSE(urgent.holdsRobot());
  EXPECT_EQ(urgent.take(), Urgent::kHome);
  EXPECT_FALSE(urgent.take());
}

TEST(UrgentRequests, AStopIsNotUndoneByWhatIsAskedLater) {
  UrgentRequests urgent;
  urgent.ask(Urgent::kStop);
  urgent.ask(Urgent::kHome);
  EXPECT_TRUE(urgent.holdsRobot());
  EXPECT_EQ(urgent.take(), Urgent::kStop);
  EXPECT_FALSE(urgent.holdsRobot());
}

TEST(Guarded, GivesUpWaitingInTime) {
  Guarded<int> value(3);
  std::promise<void> is_held;
  std::promise<void> may_go;
  auto holder = std::async(std::launch::async, [&] {
    value.with([&](int&) {
      is_held.set_value();
      may_go.get_future().wait();
    });
  });
  is_held.get_future().wait();
  const Stopwatch stopwatch;
  EXPECT_FALSE(value.tryWithFor(0.05, [](int& held) { held = 4; }));
  EXPECT_LT(stopwatch.milliseconds(), 5000.0);
  may_go.set_value();
  holder.wait();
  EXPECT_TRUE(value.tryWithFor(0.05, [](int& held) { EXPECT_EQ(held, 3); }));
}

}  // namespace
}  // namespace spelunk::bridge
