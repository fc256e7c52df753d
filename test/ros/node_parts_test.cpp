#include <gtest/gtest.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/ros/clock_watch.h"
#include "spelunk/ros/endurance_source.h"
#include "spelunk/ros/guarded.h"
#include "spelunk/ros/input_watch.h"
#include "spelunk/ros/markers.h"
#include "spelunk/ros/mesh_marker.h"
#include "spelunk/ros/mission_clock.h"
#include "spelunk/ros/pacer.h"
#include "spelunk/ros/params.h"
#include "spelunk/ros/plan_worker.h"
#include "spelunk/ros/sensor_watch.h"

namespace spelunk::bridge {
namespace {

class RecordedLog {
 public:
  RecordedLog() {
    setLogSink([this](LogLevel, const std::string& text) { lines_.push_back(text); });
  }
  ~RecordedLog() { setLogSink({}); }
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

TEST(Params, StructsBecomeDottedNamesAndListsText) {
  XmlRpc::XmlRpcValue value;
  value["map"]["resolution_m"] = 0.1;
  value["robot"]["box_m"][0] = 1;
  value["robot"]["box_m"][1] = 1.5;
  value["robot"]["kind"] = std::string("aerial");
  value["flag"] = true;
  const auto params = flattened("", value, "~set");
  ASSERT_EQ(params.size(), 4U);
  EXPECT_EQ(params[0].name, "flag");
  EXPECT_EQ(params[0].text, "true");
  EXPECT_EQ(params[1].name, "map.resolution_m");
  EXPECT_EQ(params[1].text, "0.1");
  EXPECT_EQ(params[2].text, "[1, 1.5]");
  EXPECT_EQ(params[3].origin, "~set/robot/kind");
}

TEST(Params, NestedListsAreAProblemOfTheTree) {
  XmlRpc::XmlRpcValue value;
  value["poses"][0][0] = 1.0;
  const auto params = flattened("node", value, "/planner_node");
  ASSERT_EQ(params.size(), 1U);
  EXPECT_FALSE(params[0].problem.empty());
  ParamTree tree;
  addTo(tree, params);
  try {
    tree.requireClean();
    FAIL() << "no error";
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("/planner_node/poses"), std::string::npos);
  }
}

TEST(MissionClock, BeginsWithTheFirstRosTimeAndFollowsItThereAndBack) {
  MissionClock clock;
  EXPECT_FALSE(clock.update(ros::Time(0.0)));
  EXPECT_EQ(clock.toMission(ros::Time(0.0)), 0.0) << "no /clock yet";
  EXPECT_FALSE(clock.update(ros::Time(1e9)));
  EXPECT_EQ(clock.toMission(ros::Time(1e9 + 0.5)), 0.5);
  EXPECT_NEAR(clock.toRos(0.5).toSec(), 1e9 + 0.5, 1e-6);
}

TEST(MissionClock, GoesOnFromWhereItWasAfterAJumpBack) {
  MissionClock clock;
  clock.update(ros::Time(60.0));
  clock.update(ros::Time(100.0));
  const auto back = clock.update(ros::Time(2.0));
  ASSERT_TRUE(back);
  EXPECT_NEAR(*back, 98.0, 1e-9);
  EXPECT_NEAR(clock.toMission(ros::Time(2.0)), 40.0, 1e-9);
  EXPECT_FALSE(clock.update(ros::Time(3.0)));
  EXPECT_NEAR(clock.toMission(ros::Time(3.0)), 41.0, 1e-9);
  EXPECT_NEAR(clock.toRos(41.0).toSec(), 3.0, 1e-6);
}

TEST(MissionClock, JitterIsNoJump) {
  MissionClock clock;
  clock.update(ros::Time(100.0));
  EXPECT_FALSE(clock.update(ros::Time(99.8)));
  EXPECT_FALSE(clock.update(ros::Time(99.6))) << "two small steps are not a jump either";
}

TEST(EnduranceSource, BudgetRunsFromTheStartOnly) {
  EnduranceSource source(900.0, 600.0);
  EXPECT_EQ(source.remaining(50.0), 600.0);
  source.start(50.0);
  source.start(70.0);
  EXPECT_EQ(source.remaining(150.0), 500.0);
  EXPECT_EQ(source.remaining(10000.0), 0.0);
}

TEST(EnduranceSource, WithoutBatteryARobotsOwnEnduranceCounts) {
  EnduranceSource source(300.0, 600.0);
  source.start(0.0);
  EXPECT_EQ(source.remaining(100.0), 200.0);
}

TEST(EnduranceSource, BatteryCountsAndRunsDownWhileItIsSilent) {
  EnduranceSource source(300.0, 600.0);
  source.start(0.0);
  source.onBattery(550.0, 10.0);
  EXPECT_EQ(source.remaining(10.0), 550.0);
  EXPECT_EQ(source.remaining(20.0), 540.0);
  source.onBattery(5000.0, 20.0);
  EXPECT_EQ(source.remaining(20.0), 580.0) << "never more than the budget";
}

TEST(InputWatch, SaysWhichTopicIsSilentAndWhatToRemap) {
  const RecordedLog log;
  InputWatch watch;
  const auto cloud = watch.expect({"point clouds", "/robot/points", "pointcloud", 3.0, {}, 0}, 0.0);
  watch.checkSilence(2.0);
  EXPECT_TRUE(log.lines().empty());
  watch.checkSilence(4.0);
  ASSERT_EQ(log.lines().size(), 1U);
  EXPECT_NE(log.lines()[0].find("/robot/points"), std::string::npos);
  EXPECT_NE(log.lines()[0].find("'pointcloud'"), std::string::npos);
  EXPECT_EQ(watch.current(4.0), log.lines()[0]);
  watch.heard(cloud, 5.0);
  watch.checkSilence(5.1);
  EXPECT_EQ(watch.current(10.0), "") << "the problem is over";
}

TEST(InputWatch, RepeatsAProblemAtMostOnceInFiveSeconds) {
  const RecordedLog log;
  InputWatch watch;
  for (int i = 0; i < 100; ++i) watch.report("odometry", "odometry holds NaN", 0.1 * i);
  EXPECT_EQ(log.lines().size(), 2U) << "ten seconds of it";
}

void expectParts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
}

class WaitingTest : public ::testing::Test {
 protected:
  InputWatch watch_;
  std::uint32_t publishers_ = 0;
  InputWatch::Wanted odometry_ =
      watch_.expect({"odometry", "/odom", "odometry", 3.0, [this] { return publishers_; }, 1}, 0.0);
  InputWatch::Wanted clouds_ =
      watch_.expect({"point clouds", "/points", "pointcloud", 3.0, {}, 0}, 0.0);
};

TEST_F(WaitingTest, NamesEachInputThatNeverCame) {
  expectParts(watch_.waiting(12.0),
              {"waits for odometry on '/odom': none since 12 s (publishers: 0)",
               "waits for point clouds on '/points': none since 12 s", "remap 'odometry'",
               "remap 'pointcloud'"});
}

TEST_F(WaitingTest, TellsAPublisherThatSendsNothingFromNone) {
  publishers_ = 1;
  expectParts(watch_.waiting(12.0), {"(publishers: 1): see why the publisher sends nothing"});
}

TEST_F(WaitingTest, IsOverOnceEachInputWasOfUse) {
  watch_.heard(odometry_, 1.0);
  watch_.used(odometry_, 1.0);
  EXPECT_EQ(watch_.waiting(1.1).find("odometry"), std::string::npos);
  watch_.heard(clouds_, 1.0);
  watch_.used(clouds_, 1.0);
  EXPECT_EQ(watch_.waiting(3.9), "");
}

TEST_F(WaitingTest, SaysWhyWhatArrivesIsOfNoUse) {
  const RecordedLog log;
  watch_.heard(clouds_, 5.0);
  expectParts(watch_.waiting(5.0), {"waits for usable point clouds on '/points'"});
  watch_.report(clouds_, "tf", "no transform for 'lidar'", 5.0);
  expectParts(watch_.waiting(5.0), {"waits for usable point clouds", "no transform for 'lidar'"});
}

TEST_F(WaitingTest, NoticesAStreamThatStopsInMidMission) {
  for (const auto input : {odometry_, clouds_}) {
    watch_.heard(input, 10.0);
    watch_.used(input, 10.0);
  }
  watch_.used(odometry_, 20.0);
  EXPECT_EQ(watch_.waiting(12.0), "");
  expectParts(watch_.waiting(20.0),
              {"waits for point clouds on '/points': none any more since 10 s"});
}

TEST_F(WaitingTest, TwoPublishersOfOdometryAreSaidWithTheRemedy) {
  const RecordedLog log;
  publishers_ = 2;
  watch_.checkSilence(1.0);
  ASSERT_EQ(log.lines().size(), 1U);
  expectParts(log.lines()[0], {"2 publishers of odometry on '/odom', wanted is 1",
                               "rostopic info /odom", "namespace", "remap 'odometry'"});
}

TEST(ClockWatch, SaysThatASimulatedClockNeverCame) {
  ClockWatch watch;
  const auto simulated = ClockWatch::Source::kSimulated;
  EXPECT_EQ(watch.check(ros::Time(), simulated, 100.0), "");
  EXPECT_EQ(watch.check(ros::Time(), simulated, 101.0), "") << "it may still come";
  expectParts(watch.check(ros::Time(), simulated, 102.0),
              {"use_sim_time is true", "/clock for 2 s", "--clock", "/use_sim_time to false"});
  EXPECT_EQ(watch.check(ros::Time(5.0), simulated, 103.0), "");
}

TEST(ClockWatch, SaysThatASimulatedClockStandsStill) {
  ClockWatch watch;
  const auto simulated = ClockWatch::Source::kSimulated;
  EXPECT_EQ(watch.check(ros::Time(5.0), simulated, 100.0), "");
  EXPECT_EQ(watch.check(ros::Time(5.0), simulated, 104.0), "");
  expectParts(watch.check(ros::Time(5.0), simulated, 106.0), {"stood still at 5.00 s for 6 s"});
}

TEST(ClockWatch, HasNothingToSayOfTheSystemsClock) {
  ClockWatch watch;
  for (const double real_s : {100.0, 110.0})
    EXPECT_EQ(watch.check(ros::Time(1e9), ClockWatch::Source::kSystem, real_s), "");
}

RobotModel robotWithCamera() {
  RobotModel robot;
  robot.sensor_models.resize(2);
  robot.sensor_models[1].name = "depth_front";
  robot.sensor_models[1].kind = "depth_camera";
  return robot;
}

TEST(SensorWatch, SaysOnceThatACameraIsMissingAndOnceThatItIsBack) {
  SensorWatch watch(robotWithCamera(), 3.0);
  std::vector<std::string> said;
  for (int i = 0; i < 200; ++i) {
    const double now_s = 10.0 + 0.1 * i;
    watch.heard("lidar_16", now_s);
    if (i > 100) watch.heard("depth_front", now_s);
    for (const std::string& text : watch.news(now_s)) {
      said.push_back(text);
      EXPECT_NEAR(now_s, said.size() == 1 ? 13.1 : 20.1, 0.11) << text;
    }
  }
  ASSERT_EQ(said.size(), 2U);
  EXPECT_NE(said[0].find("'depth_front'"), std::string::npos);
  EXPECT_NE(said[0].find("near the robot is seen late"), std::string::npos);
  EXPECT_NE(said[1].find("are back"), std::string::npos);
}

TEST(SensorWatch, FramesOfOtherNamesAreNotWatched) {
  SensorWatch watch(robotWithCamera(), 3.0);
  watch.heard("velodyne", 0.0);
  watch.heard("velodyne", 20.0);
  EXPECT_TRUE(watch.news(20.0).empty());
}

TEST(SensorWatch, SilenceOfAllIsLeftToTheTopic) {
  SensorWatch watch(robotWithCamera(), 3.0);
  watch.heard("depth_front", 0.0);
  EXPECT_TRUE(watch.news(50.0).empty());
  watch.heard("depth_front", 50.0);
  EXPECT_EQ(watch.news(50.0).size(), 1U) << "and the lidar is still missing";
}

TEST(Pacer, WaitsForWallTimeByTheFactor) {
  Pacer pacer(4.0);
  EXPECT_EQ(pacer.pause(0.0, 100.0), 0.0);
  EXPECT_NEAR(pacer.pause(2.0, 100.1), 0.4, 1e-9);
  EXPECT_EQ(pacer.pause(2.0, 100.55), 0.0);
}

TEST(Pacer, ABacklogIsDroppedInsteadOfRaced) {
  Pacer pacer(1.0);
  (void)pacer.pause(0.0, 0.0);
  EXPECT_EQ(pacer.pause(1.0, 5.0), 0.0) << "four seconds late";
  EXPECT_NEAR(pacer.pause(2.0, 5.0), 1.0, 1e-9) << "paced again from there";
}

visualization::Element dots(const std::string& layer) {
  visualization::Element element;
  element.layer = layer;
  element.shape = visualization::Shape::kSpheres;
  element.points = {{1, 2, 3}, {4, 5, 6}};
  element.colours = {{1, 0, 0, 1}, {0, 1, 0, 1}};
  element.size_m = 0.4;
  return element;
}

TEST(Markers, KeepLayersPointsAndColours) {
  visualization::Scene scene;
  scene.add(dots("gain/local"));
  MarkerBuilder builder;
  const auto array = builder.build(scene, "world", ros::Time(3.0));
  ASSERT_EQ(array.markers.size(), 1U);
  const auto& marker = array.markers[0];
  EXPECT_EQ(marker.ns, "gain/local");
  EXPECT_EQ(marker.type, visualization_msgs::Marker::SPHERE_LIST);
  EXPECT_EQ(marker.header.frame_id, "world");
  EXPECT_EQ(marker.points.size(), 2U);
  EXPECT_EQ(marker.colors[1].g, 1.0F);
  EXPECT_EQ(marker.scale.y, 0.4);
}

TEST(Markers, DeleteWhatTheNewSceneDoesNotHold) {
  visualization::Scene two;
  two.add(dots("a"));
  two.add(dots("a"));
  two.add(dots("b"));
  visualization::Scene one;
  one.add(dots("a"));
  MarkerBuilder builder;
  (void)builder.build(two, "world", ros::Time(1.0));
  const auto array = builder.build(one, "world", ros::Time(2.0));
  std::vector<std::pair<std::string, int>> gone;
  for (const auto& marker : array.markers)
    if (marker.action == visualization_msgs::Marker::DELETE)
      gone.emplace_back(marker.ns, marker.id);
  EXPECT_EQ(gone, (std::vector<std::pair<std::string, int>>{{"a", 1}, {"b", 0}}));
  EXPECT_EQ(builder.build(one, "world", ros::Time(3.0)).markers.size(), 1U)
      << "nothing is deleted twice";
}

TEST(MeshMarker, HasEveryTriangleAndIsLighterAbove) {
  sim::WorldMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 4}};
  mesh.triangles = {{0, 1, 2}};
  const auto marker = meshMarker(mesh, "world");
  ASSERT_EQ(marker.points.size(), 3U);
  EXPECT_EQ(marker.points[2].z, 4.0);
  EXPECT_GT(marker.colors[2].r, marker.colors[0].r);
}

TEST(Guarded, KeepsCountsRightBetweenThreads) {
  Guarded<int> number(0);
  const auto work = [&] {
    for (int i = 0; i < 10000; ++i) number.with([](int& value) { ++value; });
  };
  std::thread other(work);
  work();
  other.join();
  EXPECT_EQ(number.with([](const int& value) { return value; }), 20000);
}

TEST(Guarded, TryWithDoesNotWait) {
  Guarded<int> number(1);
  number.with([&](int&) {
    EXPECT_FALSE(std::async(std::launch::async, [&] { return number.tryWith([](int&) {}); }).get());
  });
  EXPECT_TRUE(number.tryWith([](int& value) { value = 2; }));
}

/// Answers at once, or throws.
class FakePlanner : public planners::ExplorationPlanner {
 public:
  explicit FakePlanner(bool fails) : fails_(fails) {}
  [[nodiscard]] planners::PlannerGraph graph() const override { return {}; }
  void restore(const planners::PlannerGraph& /*graph*/) override {}

 private:
  planners::PlanResult doPlan(const planners::PlanRequest& /*request*/) override {
    if (fails_) throw std::runtime_error("out of luck");
    planners::PlanResult result;
    result.status = planners::PlanStatus::kNothingToGain;
    result.reason = "all seen";
    return result;
  }
  planners::PlanResult doPlanHome(const planners::PlanRequest& request) override {
    return doPlan(request);
  }
  void doReport(const planners::PathReport& /*report*/) override {}
  bool fails_;
};

mission::PlanJob jobNumber(std::uint64_t number) {
  mission::PlanJob job;
  job.number = number;
  mission::ExplorationJob work;
  work.request.map = map::OccupancyMap(map::MapParams()).freeze();
  job.work = work;
  return job;
}

mission::PlanOutcome outcomeOf(bool fails, std::uint64_t number) {
  GuardedPlanner planner(std::make_unique<FakePlanner>(fails));
  std::promise<mission::PlanOutcome> promise;
  PlanWorker worker(planner,
                    [&](const mission::PlanOutcome& outcome) { promise.set_value(outcome); });
  worker.submit(jobNumber(number));
  return promise.get_future().get();
}

TEST(PlanWorker, HandsBackTheOutcomeOfItsJob) {
  const auto outcome = outcomeOf(false, 7);
  EXPECT_EQ(outcome.number, 7U);
  EXPECT_EQ(outcome.plan.status, planners::PlanStatus::kNothingToGain);
  EXPECT_EQ(outcome.plan.reason, "all seen");
}

TEST(PlanWorker, APlannerThatThrowsBecomesNoPathWithTheReason) {
  const RecordedLog log;
  const auto outcome = outcomeOf(true, 8);
  EXPECT_EQ(outcome.number, 8U);
  EXPECT_EQ(outcome.plan.status, planners::PlanStatus::kNoPath);
  EXPECT_NE(outcome.plan.reason.find("out of luck"), std::string::npos);
}

TEST(PlanWorker, AJobThatCannotBeDoneIsAnsweredWithTheReason) {
  const RecordedLog log;
  GuardedPlanner planner(std::make_unique<FakePlanner>(false));
  mission::PlanJob job;
  job.number = 9;
  job.work = mission::PointJob{};  // without a map
  const mission::PlanOutcome outcome = runJob(job, planner);
  EXPECT_EQ(outcome.number, 9U);
  EXPECT_NE(outcome.go_to.status, navigation::NavigationStatus::kOk);
  EXPECT_NE(outcome.go_to.reason.find("failed"), std::string::npos) << outcome.go_to.reason;
}

TEST(PlanWorker, StopsWithoutAJob) {
  GuardedPlanner planner(std::make_unique<FakePlanner>(false));
  const PlanWorker worker(planner, [](const mission::PlanOutcome&) {});
}

}  // namespace
}  // namespace spelunk::bridge
