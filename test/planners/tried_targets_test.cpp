#include "spelunk/planners/shared/tried_targets.h"

#include <gtest/gtest.h>

#include "spelunk/planners/shared/visits.h"

namespace spelunk::planners {
namespace {

const Eigen::Vector3d kTarget(5.0, 0.0, 1.0);

TEST(TriedTargets, IgnoresOutcomesThatAreNoFailure) {
  TriedTargets tried(3.0);
  for (int i = 0; i < 10; ++i) {
    tried.note(kTarget, PathOutcome::kReached, "", 0.0);
    tried.note(kTarget, PathOutcome::kReplaced, "", 0.0);
  }
  EXPECT_FALSE(tried.findRefusal(kTarget).has_value());
}

TEST(TriedTargets, GivesUpAfterRepeatedFailuresAndSaysWhy) {
  TriedTargets tried(3.0);
  tried.note(kTarget, PathOutcome::kRejectedUnsafe, "meets an obstacle", 0.0);
  EXPECT_FALSE(tried.findRefusal(kTarget).has_value());
  tried.note(kTarget + Eigen::Vector3d(1.0, 0.0, 0.0), PathOutcome::kRejectedUnsafe, "wall", 0.0);
  ASSERT_TRUE(tried.findRefusal(kTarget).has_value());
  EXPECT_EQ(*tried.findRefusal(kTarget), "tried and given up: wall");
  EXPECT_FALSE(tried.findRefusal(kTarget + Eigen::Vector3d(9.0, 0.0, 0.0)).has_value());
}

TEST(TriedTargets, DoNotAddUpDifferentReasons) {
  TriedTargets tried(3.0);
  tried.note(kTarget, PathOutcome::kRejectedUnsafe, "wall", 0.0);
  tried.note(kTarget, PathOutcome::kBlocked, "rock", 0.0);
  EXPECT_FALSE(tried.findRefusal(kTarget).has_value());
}

TEST(TriedTargets, GiveUpAtOnceWhatWasReachedInVain) {
  TriedTargets tried(3.0);
  tried.giveUp(kTarget, "nothing new was seen from there");
  ASSERT_TRUE(tried.findRefusal(kTarget + Eigen::Vector3d(0.0, 2.0, 0.0)).has_value());
  EXPECT_NE(tried.findRefusal(kTarget)->find("nothing new"), std::string::npos);
  EXPECT_FALSE(tried.findRefusal(kTarget + Eigen::Vector3d(0.0, 4.0, 0.0)).has_value());
}

TEST(TriedTargets, NeedOneRefusalForABudgetThatOnlyShrinks) {
  TriedTargets tried(3.0);
  tried.note(kTarget, PathOutcome::kRejectedBudget, "no way home fits", 0.0);
  EXPECT_TRUE(tried.findRefusal(kTarget).has_value());
}

TEST(TriedTargets, BelieveAFailureForAMinuteAndTwiceAsLongTheNextTime) {
  TriedTargets tried(3.0);
  tried.note(kTarget, PathOutcome::kRejectedBudget, "no way home fits", 100.0);
  tried.age(150.0);
  EXPECT_TRUE(tried.findRefusal(kTarget).has_value());
  tried.age(170.0);
  EXPECT_FALSE(tried.findRefusal(kTarget).has_value());
  tried.note(kTarget, PathOutcome::kRejectedBudget, "no way home fits", 170.0);
  tried.age(280.0);
  EXPECT_TRUE(tried.findRefusal(kTarget).has_value());
  tried.age(300.0);
  EXPECT_FALSE(tried.findRefusal(kTarget).has_value());
}

TEST(TriedTargets, WhatWasReachedInVainStaysGivenUp) {
  TriedTargets tried(3.0);
  tried.giveUp(kTarget, "nothing new was seen from there");
  tried.age(1e6);
  EXPECT_TRUE(tried.findRefusal(kTarget).has_value());
}

TEST(Visits, AreMadeWhenTheRobotComesByAndNotBefore) {
  Visits visits;
  visits.expect({kTarget, kTarget, 30.0, 100.0});
  PlanRequest request;
  request.pose.position = kTarget;  // the next path begins there, the robot is still on its way
  request.trail = {{99.0, {kTarget, 0.0}}, {105.0, {kTarget - Eigen::Vector3d(2, 0, 0), 0.0}}};
  EXPECT_TRUE(visits.takeMade(request, PathOutcome::kReplaced).empty());
  request.trail.push_back({108.0, {kTarget + Eigen::Vector3d(0, 0.4, 0), 0.0}});
  const auto made = visits.takeMade(request, PathOutcome::kReplaced);
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].gain_m3, 30.0);
  EXPECT_TRUE(visits.takeMade(request, PathOutcome::kReplaced).empty()) << "told twice";
}

TEST(Visits, AreMadeWhenTheRobotStandsThere) {
  Visits visits;
  visits.expect({kTarget, kTarget, 30.0, 100.0});
  PlanRequest request;
  request.pose.position = kTarget;
  EXPECT_EQ(visits.takeMade(request, PathOutcome::kReached).size(), 1U);
}

TEST(Visits, AreMadeByARobotThatMovesToAndFroAndLeavesNoTrail) {
  Visits visits;
  visits.expect({kTarget, kTarget, 30.0, 100.0});
  PlanRequest request;
  const Eigen::Vector3d away = kTarget + Eigen::Vector3d(0.0, 0.0, 1.0);
  for (const double time_s : {101.0, 102.0, 102.9}) {
    request.time_s = time_s;
    request.pose.position = time_s == 101.0 ? kTarget : away;
    EXPECT_TRUE(visits.takeMade(request, PathOutcome::kReplaced).empty())
        << "it has not looked around there by " << time_s;
  }
  request.time_s = 103.0;
  EXPECT_EQ(visits.takeMade(request, PathOutcome::kReplaced).size(), 1U);
}

TEST(Visits, AreNotMadeWhereTheRobotWasStoppedOnItsWay) {
  Visits visits;
  visits.expect({kTarget, kTarget, 30.0, 100.0});
  PlanRequest request;
  request.time_s = 101.0;
  request.pose.position = kTarget;
  EXPECT_TRUE(visits.takeMade(request, PathOutcome::kReplaced).empty());
  request.time_s = 110.0;
  request.pose.position = kTarget + Eigen::Vector3d(0.0, 0.0, 1.0);
  EXPECT_TRUE(visits.takeMade(request, PathOutcome::kBlocked).empty());
}

TEST(Visits, KnowsWhereTheRobotHasBeen) {
  const std::vector<StampedPose> trail{{0.0, {{0, 0, 0}, 0.0}}, {2.0, {{1, 0, 0}, 0.0}}};
  EXPECT_TRUE(wasVisited(trail, {1.5, 1.0, 0.0}, 1.5));
  EXPECT_FALSE(wasVisited(trail, {1.5, 1.5, 0.0}, 1.5));
  EXPECT_FALSE(wasVisited(trail, {1.0, 0.0, 6.0}, 1.5)) << "another level";
  EXPECT_FALSE(wasVisited(trail, {1.0, 0.0, 0.0}, 0.0)) << "switched off";
  EXPECT_FALSE(wasVisited({}, {0.0, 0.0, 0.0}, 1.5));
}

}  // namespace
}  // namespace spelunk::planners
