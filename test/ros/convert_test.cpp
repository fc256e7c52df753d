#include "spelunk/ros/convert.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace spelunk::bridge {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

RobotState someState() {
  RobotState state;
  state.stamp_s = 4.0;
  state.pose = {{1.0, -2.0, 3.0}, 0.8};
  state.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()) *
                                         Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  state.velocity = {1.0, 0.5, -0.2};
  state.yaw_rate = 0.3;
  return state;
}

Trajectory someTrajectory() {
  TrajectoryPoint first;
  first.time_s = 12.0;
  first.pose = {{1, 2, 3}, 3.0};
  first.velocity = {1, 0, 0};
  TrajectoryPoint second = first;
  second.time_s = 12.5;
  second.pose = {{1.5, 2, 3}, -3.0};
  second.acceleration = {0, 0.4, 0};
  second.yaw_rate = -0.2;
  return {first, second};
}

TEST(ConvertOdometry, SurvivesTheWayThereAndBack) {
  const RobotState state = someState();
  const auto message = toMsg(state, "world", "base_link", ros::Time(4.0));
  const auto back = fromMsg(message, Eigen::Isometry3d::Identity());
  ASSERT_TRUE(back.value) << back.problem;
  EXPECT_TRUE(back.value->pose.position.isApprox(state.pose.position));
  EXPECT_NEAR(back.value->pose.yaw, 0.8, 1e-9);
  EXPECT_TRUE(back.value->velocity.isApprox(state.velocity, 1e-9));
  EXPECT_EQ(back.value->stamp_s, 4.0);
}

TEST(ConvertOdometry, VelocityInTheMessageIsInTheBodyFrame) {
  RobotState state;
  state.pose.yaw = M_PI / 2;
  state.orientation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  state.velocity = {0.0, 2.0, 0.0};
  const auto message = toMsg(state, "world", "base_link", ros::Time(1.0));
  EXPECT_NEAR(message.twist.twist.linear.x, 2.0, 1e-9);
  EXPECT_NEAR(message.twist.twist.linear.y, 0.0, 1e-9);
}

TEST(ConvertOdometry, IsBroughtIntoTheWorld) {
  const auto message = toMsg(someState(), "odom", "base_link", ros::Time(4.0));
  Eigen::Isometry3d T_world_odom = Eigen::Isometry3d::Identity();
  T_world_odom.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  T_world_odom.pretranslate(Eigen::Vector3d(10, 0, 0));
  const auto state = fromMsg(message, T_world_odom);
  ASSERT_TRUE(state.value);
  EXPECT_TRUE(state.value->pose.position.isApprox(Eigen::Vector3d(9.0, 2.0, 3.0), 1e-9));
  EXPECT_TRUE(state.value->velocity.isApprox(Eigen::Vector3d(-1.0, -0.5, -0.2), 1e-9));
}

TEST(ConvertOdometry, RefusesNanAndEmptyQuaternions) {
  auto message = toMsg(someState(), "world", "base_link", ros::Time(4.0));
  auto broken = message;
  broken.pose.pose.position.y = kNan;
  EXPECT_NE(fromMsg(broken, Eigen::Isometry3d::Identity()).problem.find("not finite"),
            std::string::npos);
  broken = message;
  broken.twist.twist.linear.z = kInf;
  EXPECT_FALSE(fromMsg(broken, Eigen::Isometry3d::Identity()).value);
  broken = message;
  broken.pose.pose.orientation = geometry_msgs::Quaternion();
  EXPECT_NE(fromMsg(broken, Eigen::Isometry3d::Identity()).problem.find("zero length"),
            std::string::npos);
}

TEST(ConvertPath, SurvivesTheWayThereAndBack) {
  const Path path{{{0, 1, 2}, 0.5}, {{3, 4, 5}, -2.5}};
  const auto back = fromMsg(toMsg(path, "world", ros::Time(1.0)), "world");
  ASSERT_TRUE(back.value);
  ASSERT_EQ(back.value->size(), 2U);
  EXPECT_TRUE((*back.value)[1].position.isApprox(path[1].position));
  EXPECT_NEAR((*back.value)[1].yaw, -2.5, 1e-9);
}

TEST(ConvertPath, NamesTheFrameItRefuses) {
  const auto back = fromMsg(toMsg(Path{{{0, 0, 0}, 0.0}}, "map", ros::Time(1.0)), "world");
  EXPECT_FALSE(back.value);
  EXPECT_NE(back.problem.find("'map'"), std::string::npos);
  EXPECT_NE(back.problem.find("'world'"), std::string::npos);
}

TEST(ConvertTrajectory, SurvivesTheWayThereAndBack) {
  const Trajectory trajectory = someTrajectory();
  const auto back = fromMsg(toMsg(trajectory, "world", ros::Time(12.0)), "world");
  ASSERT_TRUE(back.value) << back.problem;
  ASSERT_EQ(back.value->size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR((*back.value)[i].time_s, trajectory[i].time_s, 1e-8);
    EXPECT_TRUE((*back.value)[i].pose.position.isApprox(trajectory[i].pose.position));
    EXPECT_NEAR((*back.value)[i].pose.yaw, trajectory[i].pose.yaw, 1e-9);
    EXPECT_TRUE((*back.value)[i].velocity.isApprox(trajectory[i].velocity));
    EXPECT_TRUE((*back.value)[i].acceleration.isApprox(trajectory[i].acceleration));
    EXPECT_EQ((*back.value)[i].yaw_rate, trajectory[i].yaw_rate);
  }
}

TEST(ConvertTrajectory, EmptyOneMeansHold) {
  const auto back = fromMsg(toMsg(Trajectory{}, "world", ros::Time(3.0)), "world");
  ASSERT_TRUE(back.value);
  EXPECT_TRUE(back.value->empty());
}

TEST(ConvertTrajectory, RefusesTimesThatDoNotRiseAndMissingTransforms) {
  auto message = toMsg(someTrajectory(), "world", ros::Time(12.0));
  auto broken = message;
  broken.points[1].time_from_start = ros::Duration(0.0);
  EXPECT_NE(fromMsg(broken, "world").problem.find("do not rise"), std::string::npos);
  broken = message;
  broken.points[0].transforms.clear();
  EXPECT_FALSE(fromMsg(broken, "world").value);
  broken = message;
  broken.points[1].velocities[0].linear.x = kNan;
  EXPECT_FALSE(fromMsg(broken, "world").value);
}

TEST(ConvertBounds, OpenSidesAreAllowedButNotNanOrEmptyBoxes) {
  EXPECT_TRUE(
      boundsFromMsg(toMsg(Eigen::Vector3d(-kInf, -1, 0)), toMsg(Eigen::Vector3d(kInf, 1, 2)))
          .value);
  EXPECT_FALSE(
      boundsFromMsg(toMsg(Eigen::Vector3d(kNan, -1, 0)), toMsg(Eigen::Vector3d(kInf, 1, 2))).value);
  EXPECT_FALSE(
      boundsFromMsg(toMsg(Eigen::Vector3d(2, -1, 0)), toMsg(Eigen::Vector3d(1, 1, 2))).value);
}

SetNoGoZones::Request oneZone() {
  SetNoGoZones::Request request;
  request.names = {"shaft"};
  request.polygons.resize(1);
  for (const float x : {0.0F, 1.0F, 2.0F}) {
    geometry_msgs::Point32 corner;
    corner.x = x;
    corner.y = x * x;
    request.polygons[0].points.push_back(corner);
  }
  request.z_min = {-1.0};
  request.z_max = {5.0};
  return request;
}

TEST(ConvertZones, ReadsNamesCornersAndHeights) {
  const auto zones = fromMsg(oneZone());
  ASSERT_TRUE(zones.value) << zones.problem;
  ASSERT_EQ(zones.value->size(), 1U);
  EXPECT_EQ(zones.value->front().name, "shaft");
  EXPECT_EQ(zones.value->front().polygon[2].y(), 4.0);
  EXPECT_EQ(zones.value->front().z_max, 5.0);
}

TEST(ConvertZones, SaysWhichZoneIsWrong) {
  auto request = oneZone();
  request.z_max = {};
  EXPECT_NE(fromMsg(request).problem.find("same number"), std::string::npos);
  request = oneZone();
  request.polygons[0].points.pop_back();
  EXPECT_NE(fromMsg(request).problem.find("'shaft'"), std::string::npos);
  request = oneZone();
  request.z_min = {6.0};
  EXPECT_NE(fromMsg(request).problem.find("z_min"), std::string::npos);
  request = oneZone();
  request.polygons[0].points[0].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(fromMsg(request).value);
}

TEST(ConvertBattery, TakesTheSmallerOfPercentageAndCharge) {
  sensor_msgs::BatteryState battery;
  battery.percentage = 0.5F;
  battery.charge = std::numeric_limits<float>::quiet_NaN();
  battery.current = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(*remainingFromMsg(battery, 800.0).value, 400.0, 1e-6);
  battery.charge = 1.0F;
  battery.current = -36.0F;  // 1 Ah at 36 A: 100 s
  EXPECT_NEAR(*remainingFromMsg(battery, 800.0).value, 100.0, 1e-3);
  battery.percentage = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(*remainingFromMsg(battery, 800.0).value, 100.0, 1e-3);
  battery.current = 5.0F;  // Charging.
  EXPECT_FALSE(remainingFromMsg(battery, 800.0).value);
}

TEST(ConvertGraph, LayersShareOneListOfVertices) {
  planners::GraphLayer local;
  local.name = "local";
  local.vertices = {{{0, 0, 0}, 1.0, false}, {{1, 0, 0}, 2.0, true}};
  local.edges = {{0, 1}};
  planners::GraphLayer global = local;
  global.name = "global";
  const Graph message = toMsg(planners::PlannerGraph{{local, global}}, "world", ros::Time(1.0));
  EXPECT_EQ(message.layers, (std::vector<std::string>{"local", "global"}));
  ASSERT_EQ(message.vertices.size(), 4U);
  EXPECT_EQ(message.layer_of_vertex, (std::vector<std::uint32_t>{0, 0, 1, 1}));
  EXPECT_EQ(message.edge_from, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(message.edge_to, (std::vector<std::uint32_t>{1, 3}));
  EXPECT_TRUE(message.is_frontier[3]);
}

TEST(ConvertStatus, EndReasonIsTheReasonOnceThereIsOne) {
  mission::MissionStatus status;
  status.state = mission::MissionState::kDone;
  status.reason = "old";
  status.end_reason = "explored";
  status.margin_s = 12.0;
  const PlannerStatus message = toMsg(status, "world", ros::Time(1.0));
  EXPECT_EQ(message.state, "Done");
  EXPECT_EQ(message.reason, "explored");
  EXPECT_EQ(message.margin_s, 12.0);
}

TEST(Convert, FindsTheBaseFromTheOdometryOfACamera) {
  // An optical frame: z ahead, x to the right; 0.3 m ahead of the base and 0.2 m above it.
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.translation() = Eigen::Vector3d(0.3, 0.0, 0.2);
  T_base_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  const Eigen::Isometry3d T_world_base =
      Eigen::Translation3d(4.0, 5.0, 0.5) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  const Eigen::Isometry3d T_world_camera = T_world_base * T_base_camera;
  RobotState camera;
  camera.pose = poseOf(T_world_camera);
  camera.orientation = Eigen::Quaterniond(T_world_camera.linear());
  camera.yaw_rate = 1.0;
  const Eigen::Vector3d lever = T_world_camera.translation() - T_world_base.translation();
  camera.velocity = Eigen::Vector3d::UnitZ().cross(lever);  // the base turns on its place
  const RobotState base = ofBase(camera, T_base_camera.inverse());
  EXPECT_LT((base.pose.position - Eigen::Vector3d(4.0, 5.0, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(base.pose.yaw, 0.5, 1e-9);
  EXPECT_NEAR((base.orientation * Eigen::Vector3d::UnitZ()).z(), 1.0, 1e-9);
  EXPECT_LT(base.velocity.norm(), 1e-9);
}

}  // namespace
}  // namespace spelunk::bridge
