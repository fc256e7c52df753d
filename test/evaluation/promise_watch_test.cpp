#include "spelunk/evaluation/promise_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "spelunk/common/log.h"
#include "spelunk/evaluation/mission_run.h"
#include "spelunk/planners/factory.h"
#include "support/meshes.h"
#include "support/short_sighted_setup.h"

namespace spelunk::evaluation {
namespace {

/// A robot that sees 8 m in a gallery of 60 x 8 x 4 m, near its west end.
RunSetup gallerySetup() { return test::shortSightedSetup({{-26.0, 0.0, 1.5}, 0.0}, 120.0); }

struct Flown {
  RunRecord record;
  std::vector<std::string> said;
};

Flown fly(const RunSetup& setup) {
  Flown flown;
  setLogSink([&](LogLevel, const std::string& text) { flown.said.push_back(text); });
  const sim::WorldMesh mesh = test::boxRoom({60.0F, 8.0F, 4.0F});
  ParamTree tree;
  const auto planner =
      planners::makePlanner("gbplanner", tree, setup.robot, setup.map.resolution_m);
  flown.record = MissionRun(setup, mesh, *planner).fly();
  setLogSink([](LogLevel, const std::string&) {});
  return flown;
}

std::string textOf(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(PromiseWatch, HoldsAtEveryTickWhereNothingNewAppears) {
  const Flown flown = fly(gallerySetup());
  EXPECT_TRUE(flown.record.returned_home) << flown.record.outcome;
  EXPECT_GT(flown.record.path_length_m, 40.0);
  EXPECT_EQ(flown.record.promise.broken_ticks, 0) << textOf(flown.record.promise.faults);
  EXPECT_EQ(flown.record.promise.unsure_s, 0.0) << flown.record.promise.unsure_why;
}

TEST(PromiseWatch, HoldsWhereRockFallsOnTheWayAndRoomIsLeftBesideIt) {
  RunSetup setup = gallerySetup();
  setup.sim.events = {"fall 12 -10 2.5 2 2 3 4"};
  const Flown flown = fly(setup);
  EXPECT_TRUE(flown.record.returned_home) << flown.record.outcome;
  EXPECT_EQ(flown.record.collisions, 0);
  EXPECT_EQ(flown.record.promise.broken_ticks, 0) << textOf(flown.record.promise.faults);
}

TEST(PromiseWatch, RockThatClosesTheGalleryBehindTheRobotIsSaidAndNeverTouched) {
  RunSetup setup = gallerySetup();
  setup.sim.events = {"fall 25 -16 0 2 2 8 4"};
  const Flown flown = fly(setup);
  EXPECT_EQ(flown.record.collisions, 0);
  EXPECT_EQ(flown.record.promise.broken_ticks, 0) << textOf(flown.record.promise.faults);
  EXPECT_GT(flown.record.promise.unsure_s, 1.0) << flown.record.outcome;
  EXPECT_EQ(flown.record.promise.unsure_why, "no known way home is clear any more");
  const bool is_said = std::any_of(flown.said.begin(), flown.said.end(), [](const auto& line) {
    return line.find("the way home is not sure") != std::string::npos ||
           line.find("no known way home is clear") != std::string::npos;
  });
  EXPECT_TRUE(is_said) << textOf(flown.said);
  EXPECT_FALSE(flown.record.outcome.empty());
}

TEST(PromiseWatch, WayHomeThroughRockIsAFault) {
  RunSetup setup = gallerySetup();
  const sim::WorldMesh mesh = test::boxRoom({60.0F, 8.0F, 4.0F});
  ParamTree tree;
  const auto planner =
      planners::makePlanner("gbplanner", tree, setup.robot, setup.map.resolution_m);
  setLogSink([](LogLevel, const std::string&) {});
  setup.time_limit_s = 60.0;
  MissionRun run(setup, mesh, *planner);
  const sim::MeshScene other(test::boxRoom({40.0F, 8.0F, 4.0F}));  // ends at x = -20
  PromiseWatch watch(run.mission(), other, setup.robot.box_m);
  static_cast<void>(run.fly([&](const Progress& progress) {
    watch.look(progress.t_s, setup.start, 0.0, PromiseWatch::Paths::kComparable);
  }));
  ASSERT_FALSE(watch.record().faults.empty());
  EXPECT_NE(textOf(watch.record().faults).find("leads through rock"), std::string::npos);
  EXPECT_GT(watch.record().broken_ticks, 0);
}

}  // namespace
}  // namespace spelunk::evaluation
