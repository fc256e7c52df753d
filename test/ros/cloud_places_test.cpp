#include "spelunk/ros/cloud_places.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace spelunk::bridge {
namespace {

RobotModel robotWith(const std::vector<std::string>& sensors) {
  RobotModel robot;
  robot.sensors = sensors;
  for (const std::string& name : sensors) {
    SensorModel sensor;
    sensor.name = name;
    if (name.rfind("depth", 0) == 0) sensor.kind = "depth_camera";
    robot.sensor_models.push_back(sensor);
  }
  robot.sensor_models[0].mount_m = {0.0, 0.0, 0.3};
  return robot;
}

Eigen::Isometry3d at(double x, double y, double z, double yaw = 0.0) {
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

/// A robot whose tf and odometry go through CloudPlaces. The tree is
/// world - odom - base_link - lidar_16, with camera_init fixed beside odom.
class CloudPlacesTest : public ::testing::Test {
 protected:
  explicit CloudPlacesTest(const std::vector<std::string>& sensors = {"lidar_16"},
                           const std::string& registered = "")
      : places_(robotWith(sensors), "world", 0.2, registered, tree()) {
    set("world", "odom", at(0, 0, 0));
    set("world", "camera_init", at(0, 0, 0));
    set("base_link", "lidar_16", at(0, 0, 0.3));
    set("odom", "local_map", at(0, 0, 0));
  }

  void set(const std::string& parent, const std::string& child, const Eigen::Isometry3d& T) {
    T_parent_[child] = T;
    parent_[child] = parent;
  }

  /// The base's pose at a time, in tf and by odometry.
  void moveTo(double stamp_s, const Eigen::Isometry3d& T_world_base,
              const std::string& base = "base_link") {
    set("odom", "base_link", T_world_base);
    places_.onOdometry("odom", base, stamp_s, T_world_base);
  }

  FromMsg<CloudPlace> find(const std::string& frame, double stamp_s) {
    return places_.find(frame, ros::Time(stamp_s));
  }

  FrameTree tree() {
    return {[this](const std::string& frame, const ros::Time&) -> FromMsg<Eigen::Isometry3d> {
              Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
              for (std::string link = frame; link != "world"; link = parent_[link]) {
                if (parent_.count(link) == 0) return {std::nullopt, "tf does not know it"};
                T = T_parent_[link] * T;
              }
              return {T, ""};
            },
            [this](const std::string& frame) -> std::optional<std::string> {
              const auto above = parent_.find(frame);
              if (above == parent_.end()) return std::nullopt;
              return above->second;
            }};
  }

  std::map<std::string, Eigen::Isometry3d> T_parent_;
  std::map<std::string, std::string> parent_;
  CloudPlaces places_;
};

TEST_F(CloudPlacesTest, ACarriedFrameIsWhereTfHasIt) {
  moveTo(10.0, at(5, 2, 1, 1.0));
  const auto place = find("lidar_16", 10.0);
  ASSERT_TRUE(place.value) << place.problem;
  EXPECT_EQ(place.value->sensor, "lidar_16");
  EXPECT_TRUE(place.value->T_world_sensor.isApprox(at(5, 2, 1.3, 1.0)));
  EXPECT_TRUE(place.value->T_base_sensor.isApprox(at(0, 0, 0.3)));
  EXPECT_TRUE(place.value->T_sensor_cloud.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(places_.news().empty());
}

TEST_F(CloudPlacesTest, APrefixBeforeASensorsNameIsNoOtherSensor) {
  CloudPlaces places(robotWith({"lidar_16"}), "world", 0.2, "", tree(), "robot_1");
  const Eigen::Isometry3d T_world_base = at(5, 2, 1);
  set("odom", "robot_1/base_link", T_world_base);
  set("robot_1/base_link", "robot_1/lidar_16", at(0, 0, 0.3));
  places.onOdometry("odom", "robot_1/base_link", 10.0, T_world_base);
  const auto place = places.find("robot_1/lidar_16", ros::Time(10.0));
  ASSERT_TRUE(place.value) << place.problem;
  EXPECT_EQ(place.value->sensor, "lidar_16");
}

/// Rays of a registered cloud begin at the sensor, and its points stay where they are in the world.
TEST_F(CloudPlacesTest, TheRaysOfRegisteredCloudsBeginAtTheRobotFromTheFirstOneOn) {
  moveTo(10.0, at(0.1, 0, 0));
  for (const char* frame : {"world", "odom"}) EXPECT_TRUE(find(frame, 10.0).value) << frame;
  moveTo(20.0, at(5, 2, 1, 1.0));
  for (const char* frame : {"world", "odom"}) {
    const auto place = find(frame, 20.0);
    ASSERT_TRUE(place.value) << place.problem;
    EXPECT_EQ(place.value->sensor, "lidar_16");
    EXPECT_TRUE(place.value->T_world_sensor.isApprox(at(5, 2, 1.3, 1.0))) << frame;
    const Eigen::Vector3d p_world(7, 3, 2);
    EXPECT_TRUE((place.value->T_world_sensor * place.value->T_sensor_cloud * p_world)
                    .isApprox(p_world, 1e-9));
  }
  const auto news = places_.news();
  ASSERT_EQ(news.size(), 2U) << "each frame is said once";
  for (const char* part : {"'world'", "registered", "sensor.lidar_16.mount_m", "0.3"})
    EXPECT_NE(news[0].find(part), std::string::npos) << part << " in " << news[0];
}

TEST_F(CloudPlacesTest, RegisteredCloudsWaitForOdometryFromAfterThem) {
  moveTo(10.0, at(0, 0, 0));
  const auto early = find("odom", 10.5);
  EXPECT_FALSE(early.value);
  EXPECT_NE(early.problem.find("odometry"), std::string::npos);
  moveTo(11.0, at(1, 0, 0));
  const auto place = find("odom", 10.5);
  ASSERT_TRUE(place.value);
  EXPECT_NEAR(place.value->T_world_sensor.translation().x(), 0.5, 1e-9);
}

TEST_F(CloudPlacesTest, AFrameBesideTheRobotsIsToldByItsMotion) {
  moveTo(10.0, at(0, 0, 0));
  ASSERT_TRUE(find("camera_init", 10.0).value);
  moveTo(11.0, at(0.5, 0, 0));
  const auto place = find("camera_init", 11.0);
  ASSERT_TRUE(place.value) << place.problem;
  EXPECT_NEAR(place.value->T_world_sensor.translation().x(), 0.5, 1e-9) << "it stays: registered";
}

TEST_F(CloudPlacesTest, ATurnTellsAsWell) {
  moveTo(10.0, at(0, 0, 0));
  ASSERT_TRUE(find("local_map", 10.0).value);
  moveTo(11.0, at(0, 0, 0, 0.5));
  const auto place = find("local_map", 11.0);
  ASSERT_TRUE(place.value);
  EXPECT_TRUE(place.value->T_world_sensor.isApprox(at(0, 0, 0.3, 0.5)));
}

TEST_F(CloudPlacesTest, ASensorWithItsOwnTransformFromTheWorldIsCarried) {
  for (int i = 0; i < 5; ++i) {
    moveTo(10.0 + i, at(i, 0, 0), "");  // No child_frame_id either.
    set("world", "velodyne", at(i, 0, 0.2));
    const auto place = find("velodyne", 10.0 + i);
    ASSERT_TRUE(place.value) << place.problem;
    EXPECT_TRUE(place.value->T_world_sensor.isApprox(at(i, 0, 0.2)));
    EXPECT_TRUE(place.value->T_sensor_cloud.isApprox(Eigen::Isometry3d::Identity()));
  }
}

TEST_F(CloudPlacesTest, BaseFootprintAboveTheBaseIsCarried) {
  for (int i = 0; i < 5; ++i) {
    set("odom", "base_footprint", at(i, 0, 0));
    set("base_footprint", "base_link", at(0, 0, 0.5));
    places_.onOdometry("odom", "base_link", 10.0 + i, at(i, 0, 0.5));
    const auto place = find("base_footprint", 10.0 + i);
    ASSERT_TRUE(place.value) << place.problem;
    EXPECT_TRUE(place.value->T_world_sensor.isApprox(at(i, 0, 0)));
  }
}

TEST_F(CloudPlacesTest, AFixedFrameFarFromTheRobotIsToldAtOnce) {
  moveTo(10.0, at(80, -20, 4));
  const auto place = find("camera_init", 10.0);
  ASSERT_TRUE(place.value) << place.problem;
  EXPECT_TRUE(place.value->T_world_sensor.isApprox(at(80, -20, 4.3)));
}

TEST_F(CloudPlacesTest, NoCloudIsPlacedBeforeOdometry) {
  set("odom", "base_link", at(0, 0, 0));
  const auto place = find("lidar_16", 10.0);
  EXPECT_FALSE(place.value);
  EXPECT_NE(place.problem.find("no odometry yet"), std::string::npos);
}

TEST_F(CloudPlacesTest, ATreeThatContradictsOdometryIsRefusedWithNumbersAndRemedy) {
  moveTo(10.0, at(0, 0, 0));
  places_.onOdometry("odom", "base_link", 11.0, at(9, 0, 0));  // tf stands still.
  const auto place = find("lidar_16", 11.0);
  ASSERT_FALSE(place.value);
  for (const char* part : {"9.0 m", "2.9 m", "one source", "robot.box_m"})
    EXPECT_NE(place.problem.find(part), std::string::npos) << part << " in " << place.problem;
}

class CloudPlacesOfTwoLidars : public CloudPlacesTest {
 protected:
  CloudPlacesOfTwoLidars() : CloudPlacesTest({"lidar_16", "lidar_rear"}) {}
};

TEST_F(CloudPlacesOfTwoLidars, AreRefusedWithTheRemedyWhereTheSensorIsNotKnown) {
  moveTo(10.0, at(0, 0, 0));
  const auto place = find("odom", 10.0);
  ASSERT_FALSE(place.value);
  for (const char* part : {"lidar_16, lidar_rear", "cloud/registered_sensor", "remap"})
    EXPECT_NE(place.problem.find(part), std::string::npos) << part << " in " << place.problem;
  EXPECT_TRUE(find("lidar_16", 10.0).value) << "the other one is not registered";
}

class CloudPlacesWithNamedSensor : public CloudPlacesTest {
 protected:
  CloudPlacesWithNamedSensor() : CloudPlacesTest({"lidar_16", "lidar_rear"}, "lidar_rear") {}
};

TEST_F(CloudPlacesWithNamedSensor, TakesTheNamedOne) {
  moveTo(10.0, at(1, 0, 0));
  EXPECT_EQ(find("odom", 10.0).value->sensor, "lidar_rear");
}

class CloudPlacesOfLidarAndCamera : public CloudPlacesTest {
 protected:
  CloudPlacesOfLidarAndCamera() : CloudPlacesTest({"depth_front", "lidar_16"}) {}
};

TEST_F(CloudPlacesOfLidarAndCamera, TakesTheOnlyLidar) {
  moveTo(10.0, at(1, 0, 0));
  EXPECT_EQ(find("odom", 10.0).value->sensor, "lidar_16");
}

TEST(PoseTrack, LiesBetweenItsNeighboursInTime) {
  PoseTrack track;
  EXPECT_FALSE(track.nearest(1.0));
  track.add(10.0, at(0, 0, 0));
  track.add(11.0, at(2, 0, 0, 1.0));
  track.add(10.5, at(99, 0, 0));  // Out of order.
  EXPECT_FALSE(track.at(9.9));
  EXPECT_FALSE(track.at(11.1));
  EXPECT_TRUE(track.at(10.25)->isApprox(at(0.5, 0, 0, 0.25)));
  EXPECT_TRUE(track.nearest(50.0)->isApprox(at(2, 0, 0, 1.0)));
  track.add(40.0, at(0, 0, 0));
  EXPECT_FALSE(track.at(11.0)) << "older than it keeps";
}

}  // namespace
}  // namespace spelunk::bridge
