#include "spelunk/mission/transitions.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace spelunk::mission {
namespace {

TEST(Transitions, EveryPairHasAtMostOneRule) {
  std::set<std::pair<Task, Event>> seen;
  for (const Rule& rule : rules())
    EXPECT_TRUE(seen.emplace(rule.from, rule.event).second)
        << static_cast<int>(rule.from) << ", " << static_cast<int>(rule.event);
}

TEST(Transitions, ListsOfTasksAndEventsHoldAllThatRulesName) {
  const std::set<Task> tasks(allTasks().begin(), allTasks().end());
  const std::set<Event> events(allEvents().begin(), allEvents().end());
  for (const Rule& rule : rules()) {
    EXPECT_EQ(tasks.count(rule.from) + tasks.count(rule.next), 2U);
    EXPECT_EQ(events.count(rule.event), 1U) << static_cast<int>(rule.event);
  }
}

TEST(Transitions, WhatIsIgnoredLeavesTheTaskAsItIs) {
  for (const Task task : allTasks())
    for (const Event event : allEvents()) {
      const Rule rule = ruleFor(task, event);
      EXPECT_EQ(rule.from, task);
      EXPECT_EQ(rule.event, event);
      if (rule.action == Action::kIgnore) {
        EXPECT_EQ(rule.next, task);
      }
    }
}

TEST(Transitions, ActionAndNextTaskAgreeInEveryRule) {
  for (const Rule& rule : rules()) {
    SCOPED_TRACE(std::to_string(static_cast<int>(rule.from)) + ", " +
                 std::to_string(static_cast<int>(rule.event)));
    EXPECT_EQ(rule.action == Action::kHalt, rule.next == Task::kStopped);
    EXPECT_EQ(rule.action == Action::kFinish, rule.next == Task::kDone);
    if (rule.action == Action::kTurnHome) {
      EXPECT_EQ(rule.next, Task::kHome);
    }
    if (rule.action == Action::kExplore) {
      EXPECT_EQ(rule.next, Task::kExplore);
    }
    if (rule.action == Action::kBackOff) {
      EXPECT_EQ(rule.next, rule.from);
    }
    EXPECT_NE(rule.next, Task::kIdle) << "nothing makes a mission one that never began";
  }
}

TEST(Transitions, EveryTaskCanBeStoppedAtOnce) {
  for (const Task task : allTasks())
    EXPECT_EQ(ruleFor(task, Event::kStopAsked).next, Task::kStopped);
}

TEST(Transitions, OnlyAStartReleasesAStop) {
  for (const Event event : allEvents())
    EXPECT_EQ(ruleFor(Task::kStopped, event).next,
              event == Event::kStartAsked ? Task::kExplore : Task::kStopped);
}

TEST(Transitions, EveryRunningTaskStopsForDangerAndKeepsItsAim) {
  for (const Task task : allTasks()) {
    if (!isRunning(task)) continue;
    for (const Event event : {Event::kInputsFailed, Event::kLeftPath, Event::kPathIgnored,
                              Event::kObstacleAhead, Event::kGroundUnseen, Event::kGroundBad}) {
      const Rule rule = ruleFor(task, event);
      EXPECT_TRUE(rule.action == Action::kHold || rule.action == Action::kBackOff);
      EXPECT_EQ(rule.next, task);
    }
    EXPECT_EQ(ruleFor(task, Event::kFell).next, Task::kStopped);
    EXPECT_EQ(ruleFor(task, Event::kPauseAsked).next, Task::kPaused);
  }
}

TEST(Transitions, LowEnduranceLeavesNoTaskButHome) {
  for (const Task task : allTasks())
    if (isRunning(task) && task != Task::kLand) {  // it is at home
      EXPECT_EQ(ruleFor(task, Event::kEnduranceLow).next, Task::kHome);
    }
}

TEST(Transitions, WhatHappensOnTheWayMattersToRunningTasksOnly) {
  const std::set<Event> asked{Event::kStartAsked, Event::kPauseAsked, Event::kHomeAsked,
                              Event::kPointAsked, Event::kStopAsked};
  for (const Task task : allTasks())
    for (const Event event : allEvents())
      if (!isRunning(task) && asked.count(event) == 0) {
        EXPECT_EQ(ruleFor(task, event).action, Action::kIgnore);
      }
}

TEST(Transitions, EveryTaskCanStillComeHome) {
  for (const Task begin : allTasks()) {
    std::set<Task> reached{begin};
    for (std::size_t before = 0; before != reached.size();) {
      before = reached.size();
      for (const Rule& rule : rules())
        if (reached.count(rule.from) > 0) reached.insert(rule.next);
    }
    EXPECT_EQ(reached.count(Task::kDone), 1U) << static_cast<int>(begin);
  }
}

}  // namespace
}  // namespace spelunk::mission
