#include <gtest/gtest.h>

#include "mission_impl.h"
#include "support/scripted_flight.h"

namespace spelunk::mission {

/// Looks into a mission: what each part is about to do after each pair of task and event.
struct MissionProbe {
  using Parts = Mission::Impl;
};

namespace {

using planners::PathKind;
using Parts = MissionProbe::Parts;

const Pose kStart{{3.0, 2.5, 2.5}, 0.0};

/// A mission in a known corridor whose parts are all in the middle of something.
class BusyMission : public testing::Test {
 protected:
  void SetUp() override {
    setLogSink([](LogLevel, const std::string&) {});
  }

  static void makeBusy(Parts& parts, Task task) {
    test::corridorWorld(30.0).enterInto(parts.space.map());
    RobotState state;
    state.pose = kStart;
    parts.takeOdometry(state);
    parts.takeOff();
    for (; state.pose.position.x() < 6.0; state.pose.position.x() += 0.5, state.stamp_s += 0.5)
      parts.takeOdometry(state);
    parts.inputs_ok = true;
    parts.updateEndurance();
    PointJob job;
    job.query.goal = {{9.0, 2.5, 2.5}, 0.0};
    parts.point.begin(job, 0.0);
    const Pose here = parts.watch.pose();
    parts.flight.fly(Leg({here, {{9.0, 2.5, 2.5}, 0.0}}, PathKind::kLocal, parts.robot.box_m), here,
                     0.0);
    parts.desk.ask(Task::kExplore, parts.way_home, 0.0);
    parts.ground.askToBackOff();
    parts.task = task;
    ASSERT_TRUE(parts.desk.isBusy());
  }
};

TEST_F(BusyMission, NoPartCarriesOnForATaskThatHasEnded) {
  for (const Task task : allTasks())
    for (const Event event : allEvents()) {
      SCOPED_TRACE(std::to_string(static_cast<int>(task)) + ", " +
                   std::to_string(static_cast<int>(event)));
      Parts parts({}, test::smallRobot(), test::coarseMap(), 1, {});
      makeBusy(parts, task);
      const Rule rule = ruleFor(task, event);
      parts.happens(event, "the test says so");
      EXPECT_EQ(parts.task, rule.next);
      if (rule.action == Action::kIgnore) {
        EXPECT_TRUE(parts.ground.isToBackOff() && parts.desk.isBusy() && parts.flight.active());
        continue;
      }
      const bool is_new_task = rule.next != task;
      if (is_new_task) {
        EXPECT_FALSE(parts.ground.isToBackOff()) << "the ground ahead would not be looked at";
        EXPECT_FALSE(parts.desk.isBusy()) << "its answer would be taken for the new task";
        EXPECT_FALSE(parts.point.plan()) << "the point would still be flown to";
      }
      if (rule.action == Action::kBackOff) {
        EXPECT_TRUE(parts.ground.isToBackOff());
      }
      const bool stops = rule.action == Action::kHold || rule.action == Action::kBackOff ||
                         rule.action == Action::kHalt || rule.action == Action::kFinish;
      if (stops) {
        EXPECT_FALSE(parts.flight.active());
        const auto command = parts.flight.takeCommand();
        ASSERT_TRUE(command);
        EXPECT_TRUE(command->path.empty()) << "the robot is told to stop";
      }
      if (rule.action == Action::kTurnHome) {
        EXPECT_TRUE(parts.flight.goesHome());
      }
    }
}

TEST_F(BusyMission, TurningHomeIsUndoneOnlyWhenItsCauseIsGone) {
  for (const Event cause :
       {Event::kWayHomeLost, Event::kEnduranceLow, Event::kNothingLeft, Event::kHomeAsked}) {
    Parts parts({}, test::smallRobot(), test::coarseMap(), 1, {});
    makeBusy(parts, Task::kExplore);
    parts.happens(cause, "the test says so");
    ASSERT_EQ(parts.task, Task::kHome);
    parts.now = 1.0;
    parts.checkCause();  // the trail is free: a way home is known
    const bool is_gone = cause == Event::kWayHomeLost;
    EXPECT_EQ(parts.task, is_gone ? Task::kExplore : Task::kHome);
    EXPECT_TRUE(parts.flight.active()) << "what is flown goes on meanwhile";
  }
}

TEST(RobotWatch, WaitsLongerForSensorsThatAreSlow) {
  RobotModel robot = test::smallRobot();
  EXPECT_DOUBLE_EQ(scanSilence(robot), 1.0);
  robot.sensor_models.front().rate_hz = 0.2;
  EXPECT_DOUBLE_EQ(scanSilence(robot), 15.0);
}

}  // namespace
}  // namespace spelunk::mission
