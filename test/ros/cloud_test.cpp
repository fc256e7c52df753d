#include <gtest/gtest.h>
#include <sensor_msgs/PointField.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "spelunk/ros/cloud_filter.h"
#include "spelunk/ros/pending_clouds.h"
#include "spelunk/ros/stamp_check.h"

namespace spelunk::bridge {
namespace {

using Points = std::vector<Eigen::Vector3f>;

sensor_msgs::PointCloud2 cloudOf(const Points& points) {
  return toMsg(points, "lidar", ros::Time(10.0));
}

/// Doubles in the order z, x, y behind four bytes of something else, two rows with padding.
sensor_msgs::PointCloud2 oddCloud() {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "lidar";
  cloud.height = 2;
  cloud.width = 1;
  cloud.point_step = 28;
  cloud.row_step = 32;
  const char* names[] = {"z", "x", "y"};
  for (std::uint32_t i = 0; i < 3; ++i) {
    sensor_msgs::PointField field;
    field.name = names[i];
    field.offset = 4 + 8 * i;
    field.datatype = sensor_msgs::PointField::FLOAT64;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.data.resize(60);
  for (std::uint32_t row = 0; row < 2; ++row)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const double value = 10.0 * row + i;  // z, x, y = 0, 1, 2
      std::memcpy(&cloud.data[row * 32 + 4 + 8 * i], &value, sizeof(value));
    }
  return cloud;
}

TEST(CloudPoints, SurviveTheWayThereAndBack) {
  const Points points{{1, 2, 3}, {-4, 5, 6}};
  const auto back = pointsFromMsg(cloudOf(points));
  ASSERT_TRUE(back.value);
  EXPECT_EQ(*back.value, points);
}

TEST(CloudPoints, DoublesFarFromTheOriginReachTheSensorsFrameToTheMillimetre) {
  sensor_msgs::PointCloud2 cloud = oddCloud();
  const double northing = 5420002.3;  // y of the first point
  std::memcpy(&cloud.data[4 + 8 * 2], &northing, sizeof(northing));
  const Eigen::Isometry3d T_sensor_cloud(Eigen::Translation3d(0.0, -5420000.0, 0.0));
  const auto points = pointsFromMsg(cloud, T_sensor_cloud);
  ASSERT_TRUE(points.value) << points.problem;
  EXPECT_NEAR((*points.value)[0].y(), 2.3, 1e-6);
}

TEST(CloudPoints, NumbersOf32BitsAreCoarseFarFromTheOrigin) {
  EXPECT_EQ(coordinateError(cloudOf({{1, 2, 3}}), 5.42e6), 0.25);
  EXPECT_EQ(coordinateError(oddCloud(), 5.42e6), 0.0);
  EXPECT_LT(coordinateError(cloudOf({{1, 2, 3}}), 100.0), 1e-5);
}

TEST(CloudPoints, ReadsDoublesAtAnyOffsetAndPaddedRows) {
  const auto points = pointsFromMsg(oddCloud());
  ASSERT_TRUE(points.value) << points.problem;
  EXPECT_EQ(*points.value, (Points{{1, 2, 0}, {11, 12, 10}}));
}

TEST(CloudPoints, LeavesOutWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const auto points = pointsFromMsg(cloudOf({{nan, 0, 0}, {1, 2, 3}, {0, inf, 0}}));
  ASSERT_TRUE(points.value);
  EXPECT_EQ(*points.value, (Points{{1, 2, 3}}));
}

TEST(CloudPoints, RefusesCloudsThatHoldNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(pointsFromMsg(cloudOf({})).problem.find("no points"), std::string::npos);
  EXPECT_NE(pointsFromMsg(cloudOf({{nan, nan, nan}})).problem.find("NaN"), std::string::npos);
}

TEST(CloudPoints, RefusesLayoutsThatDoNotFit) {
  auto cloud = cloudOf({{1, 2, 3}, {4, 5, 6}});
  auto broken = cloud;
  broken.fields[1].name = "intensity";
  EXPECT_NE(pointsFromMsg(broken).problem.find("'y'"), std::string::npos);
  broken = cloud;
  broken.fields[2].datatype = sensor_msgs::PointField::INT16;
  EXPECT_NE(pointsFromMsg(broken).problem.find("'z'"), std::string::npos);
  broken = cloud;
  broken.fields[2].offset = 10;
  EXPECT_NE(pointsFromMsg(broken).problem.find("point_step"), std::string::npos);
  broken = cloud;
  broken.data.pop_back();
  EXPECT_NE(pointsFromMsg(broken).problem.find("more points"), std::string::npos);
  broken = cloud;
  broken.width = 4000000000U;
  EXPECT_FALSE(pointsFromMsg(broken).value);
}

/// Two rows of two points.
sensor_msgs::PointCloud2 organisedCloud() {
  auto cloud = cloudOf({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}});
  cloud.height = 2;
  cloud.width = 2;
  cloud.row_step = 24;
  return cloud;
}

TEST(CloudPoints, TakesStepsFromTheSizeWhereTheMessageHasThemWrong) {
  const Points wanted = *pointsFromMsg(organisedCloud()).value;
  ASSERT_EQ(wanted.size(), 4U);
  for (const std::uint32_t row_step : {0U, 12U, 48U, 4000U}) {
    auto cloud = organisedCloud();
    cloud.row_step = row_step;
    const auto points = pointsFromMsg(cloud);
    ASSERT_TRUE(points.value) << row_step << ": " << points.problem;
    EXPECT_EQ(*points.value, wanted) << row_step;
  }
  auto cloud = organisedCloud();
  cloud.point_step = 0;
  EXPECT_EQ(*pointsFromMsg(cloud).value, wanted);
}

TEST(CloudPoints, ReadsTheOtherOrderOfBytes) {
  auto cloud = organisedCloud();
  const Points wanted = *pointsFromMsg(cloud).value;
  for (std::size_t i = 0; i < cloud.data.size(); i += 4)
    std::reverse(cloud.data.begin() + static_cast<long>(i),
                 cloud.data.begin() + static_cast<long>(i) + 4);
  cloud.is_bigendian = true;
  EXPECT_EQ(*pointsFromMsg(cloud).value, wanted);
}

TEST(CloudPoints, DoesNotBelieveIsDense) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  auto cloud = cloudOf({{nan, 0, 0}, {1, 2, 3}});
  cloud.is_dense = true;
  EXPECT_EQ(*pointsFromMsg(cloud).value, (Points{{1, 2, 3}}));
}

/// Each refusal with what it must hold: what is wrong, the number seen, the remedy.
TEST(CloudPoints, EveryRefusalNamesNumbersAndRemedy) {
  using Spoil = void (*)(sensor_msgs::PointCloud2&);
  struct Case {
    const char* what;
    Spoil spoil;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases{
      {"no points", [](auto& c) { c.width = 0; }, {"width 0", "height 2", "check"}},
      {"size",
       [](auto& c) { c.data.resize(47); },
       {"width 2", "height 2", "point_step 12", "row_step 24", "48 bytes", "47", "must set"}},
      {"point_step", [](auto& c) { c.point_step = 13; }, {"point_step 13", "52 bytes", "must set"}},
      {"intensity only",
       [](auto& c) {
         c.fields.erase(c.fields.begin(), c.fields.begin() + 2);
         c.fields[0].name = "intensity";
       },
       {"'x'", "'intensity'", "remap 'pointcloud'"}},
      {"no fields", [](auto& c) { c.fields.clear(); }, {"'x'", "none", "remap"}},
      {"type",
       [](auto& c) { c.fields[2].datatype = sensor_msgs::PointField::INT16; },
       {"'z'", "datatype 3", "FLOAT32 (7)", "driver"}},
      {"offset",
       [](auto& c) { c.fields[2].offset = 10; },
       {"'z'", "10 to 14", "point_step 12", "must set"}}};
  for (const Case& test : cases) {
    auto cloud = organisedCloud();
    test.spoil(cloud);
    const auto points = pointsFromMsg(cloud);
    EXPECT_FALSE(points.value) << test.what;
    for (const std::string& part : test.parts)
      EXPECT_NE(points.problem.find(part), std::string::npos) << part << " in " << points.problem;
  }
}

TEST(StampCheck, AcceptsWhatIsWithinTheLimits) {
  const CloudParams limits;
  for (const double stamp : {95.1, 100.0, 100.4})
    EXPECT_EQ(stampProblem(ros::Time(stamp), ros::Time(100.0), limits), "") << stamp;
  EXPECT_EQ(stampProblem(ros::Time(0.0), ros::Time(1.0), limits), "") << "simulations begin at 0";
}

TEST(StampCheck, NamesTheOtherClockAndTheRemedy) {
  struct Case {
    double stamp_s;
    double now_s;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases{
      {0.0, 1.7e9, {"stamp 0", "header.stamp"}},
      {4321.5, 1.7e9, {"4321.50 s", "own clock", "/use_sim_time"}},
      {1.7e9 - 315964800.0, 1.7e9, {"own clock"}},
      {4.2e9, 100.0, {"in the future", "another clock", "/use_sim_time"}},
      {1.7e9 + 18.0, 1.7e9, {"18.00 s in the future", "0.50 s", "GPS", "cloud/future_max_s"}},
      {1.7e9 + 37.0, 1.7e9, {"TAI", "37"}},
      {50.5, 100.0, {"49.50 s old", "5.00 s", "clocks", "cloud/age_max_s"}}};
  for (const Case& test : cases) {
    const std::string problem =
        stampProblem(ros::Time(test.stamp_s), ros::Time(test.now_s), CloudParams());
    for (const std::string& part : test.parts)
      EXPECT_NE(problem.find(part), std::string::npos) << part << " in " << problem;
  }
}

/// A dense plane and one lonely speck of dust.
Points planeAndSpeck() {
  Points points;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      points.emplace_back(0.05F * static_cast<float>(i), 0.05F * static_cast<float>(j), 0.0F);
  points.emplace_back(5.0F, 5.0F, 5.0F);
  return points;
}

bool holdsSpeck(const Points& points) {
  for (const Eigen::Vector3f& point : points)
    if (point.z() > 1.0F) return true;
  return false;
}

TEST(CloudFilter, IsOffByDefault) {
  EXPECT_EQ(filtered(planeAndSpeck(), CloudParams()), planeAndSpeck());
}

TEST(CloudFilter, BothOutlierFiltersRemoveTheSpeckAndKeepThePlane) {
  for (const char* name : {"statistical", "radius"}) {
    CloudParams params;
    params.outlier_filter = name;
    params.outlier_neighbours = 3;
    const Points points = filtered(planeAndSpeck(), params);
    EXPECT_FALSE(holdsSpeck(points)) << name;
    EXPECT_GT(points.size(), 380U) << name;
  }
}

TEST(CloudFilter, VoxelGridLeavesOnePointAVoxel) {
  CloudParams params;
  params.voxel_size_m = 0.5;
  const Points points = filtered(planeAndSpeck(), params);
  EXPECT_GE(points.size(), 5U);
  EXPECT_LE(points.size(), 10U);
  EXPECT_TRUE(holdsSpeck(points));
}

TEST(CloudParams, NamesAnUnknownFilter) {
  CloudParams params;
  EXPECT_TRUE(params.problems().empty());
  params.outlier_filter = "median";
  ASSERT_EQ(params.problems().size(), 1U);
  EXPECT_NE(params.problems()[0].find("'median'"), std::string::npos);
}

class PendingCloudsTest : public ::testing::Test {
 protected:
  static sensor_msgs::PointCloud2::ConstPtr at(double stamp_s, const std::string& frame = "lidar") {
    sensor_msgs::PointCloud2 cloud = cloudOf({{1, 2, 3}});
    cloud.header.frame_id = frame;
    cloud.header.stamp = ros::Time(stamp_s);
    return boost::make_shared<const sensor_msgs::PointCloud2>(cloud);
  }

  PlaceLookup lookup_ = [this](const std::string& frame, const ros::Time& stamp) {
    asked_ = frame;
    if (stamp.toSec() > known_until_s_) return FromMsg<CloudPlace>{std::nullopt, "later"};
    return FromMsg<CloudPlace>{CloudPlace(), ""};
  };
  std::string asked_;
  double known_until_s_ = 1000.0;
  PendingClouds pending_{CloudParams()};
};

TEST_F(PendingCloudsTest, HandsOverWhatHasATransform) {
  EXPECT_EQ(pending_.push(at(10.0), ros::Time(10.1)), "");
  const auto items = pending_.take(lookup_, ros::Time(10.1));
  ASSERT_EQ(items.size(), 1U);
  EXPECT_EQ(items[0].problem, "");
  EXPECT_EQ(pending_.size(), 0U);
}

TEST_F(PendingCloudsTest, WaitsForATransformAndThenGivesUp) {
  known_until_s_ = 9.0;
  EXPECT_EQ(pending_.push(at(10.0), ros::Time(10.0)), "");
  EXPECT_TRUE(pending_.take(lookup_, ros::Time(10.2)).empty());
  EXPECT_EQ(pending_.size(), 1U);
  const auto items = pending_.take(lookup_, ros::Time(10.6));
  ASSERT_EQ(items.size(), 1U);
  EXPECT_NE(items[0].problem.find("'lidar'"), std::string::npos);
  EXPECT_NE(items[0].problem.find("later"), std::string::npos);
}

TEST_F(PendingCloudsTest, AsksForFramesWithoutTheSlashOfTf1) {
  EXPECT_EQ(pending_.push(at(10.0, "/lidar"), ros::Time(10.1)), "");
  EXPECT_EQ(pending_.take(lookup_, ros::Time(10.1)).size(), 1U);
  EXPECT_EQ(asked_, "lidar");
}

TEST_F(PendingCloudsTest, KeepsTheOrderOfClouds) {
  for (const double stamp : {10.0, 10.1, 10.2})
    EXPECT_EQ(pending_.push(at(stamp), ros::Time(10.2)), "");
  known_until_s_ = 10.15;
  EXPECT_EQ(pending_.take(lookup_, ros::Time(10.2)).size(), 2U);
  known_until_s_ = 11.0;
  const auto rest = pending_.take(lookup_, ros::Time(10.3));
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_EQ(rest[0].cloud->header.stamp, ros::Time(10.2));
}

TEST_F(PendingCloudsTest, RefusesTheFutureTheLongPastAndNamelessFrames) {
  EXPECT_NE(pending_.push(at(12.0), ros::Time(10.0)).find("future"), std::string::npos);
  EXPECT_NE(pending_.push(at(2.0), ros::Time(10.0)).find("old"), std::string::npos);
  EXPECT_NE(pending_.push(at(10.0, ""), ros::Time(10.0)).find("frame_id"), std::string::npos);
  EXPECT_EQ(pending_.size(), 0U);
}

TEST_F(PendingCloudsTest, NeverGrowsBeyondItsCapacity) {
  known_until_s_ = 0.0;
  for (std::size_t i = 0; i < 3 * PendingClouds::kCapacity; ++i)
    EXPECT_EQ(pending_.push(at(10.0), ros::Time(10.0)), "");
  EXPECT_EQ(pending_.size(), PendingClouds::kCapacity);
}

}  // namespace
}  // namespace spelunk::bridge
