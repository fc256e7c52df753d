#include "spelunk/common/self_returns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace spelunk {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// A corridor along x: walls, floor and roof at these distances from its middle line, ends far off.
struct Corridor {
  double half_width_m = 1.0;
  double half_height_m = 1.0;
  double half_length_m = 40.0;
};

/// A robot of 1.1 x 1.1 x 0.4 m with a LiDAR in its middle and a hoop of its own around it.
class SeeingRobot {
 public:
  explicit SeeingRobot(double hoop_m, const Corridor& corridor = {})
      : hoop_m_(hoop_m), corridor_(corridor) {}

  /// One scan from a place in the corridor.
  Points scanFrom(const Eigen::Isometry3d& T_world_base) const {
    Points points;
    for (int row = -7; row <= 7; ++row)
      for (int column = 0; column < 360; ++column) {
        const double azimuth = column * M_PI / 180.0;
        const double elevation = 2.0 * row * M_PI / 180.0;
        const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        points.push_back((rangeOf(T_world_base, ray) * ray).cast<float>());
      }
    return points;
  }

 private:
  double rangeOf(const Eigen::Isometry3d& T_world_base, const Eigen::Vector3d& ray) const {
    const Eigen::Vector3d direction = T_world_base.linear() * ray;
    const Eigen::Vector3d half(corridor_.half_length_m, corridor_.half_width_m,
                               corridor_.half_height_m);
    double range = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(direction[axis]) > 1e-9)
        range = std::min(
            range, (std::copysign(half[axis], direction[axis]) - T_world_base.translation()[axis]) /
                       direction[axis]);
    const double to_hoop = hoop_m_ / ray.head<2>().norm();
    if (hoop_m_ > 0.0 && std::abs(to_hoop * ray.z()) < 0.05) range = std::min(range, to_hoop);
    return range;
  }

  double hoop_m_;
  Corridor corridor_;
};

Eigen::Isometry3d along(double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 0.0)); }

/// Ten scans a second on a way of `way_m` along the corridor at 1 m/s, or of one second at rest.
void fly(const SeeingRobot& robot, double way_m, SelfReturns& returns) {
  const int scans = 10 + static_cast<int>(10.0 * way_m);
  for (int i = 0; i < scans; ++i) {
    const Eigen::Isometry3d pose = along(std::min(way_m, 0.1 * i));
    (void)returns.without("lidar", robot.scanFrom(pose), Eigen::Isometry3d::Identity(), pose);
  }
}

void expectParts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
}

TEST(SelfReturns, InsideTheSafetyBoxAreNamedBeforeTheRobotHasMoved) {
  SelfReturns returns(RobotModel(), 0.4);
  fly(SeeingRobot(0.5), 0.0, returns);
  expectParts(returns.finding(),
              {"'lidar'", "0.50", "inside the robot's own box", "[1.1, 1.1, 0.4]",
               "robot.self_filter_boxes_m: [", "map.range_min_m: 0.6"});
}

TEST(SelfReturns, OutsideTheSafetyBoxAreADoubtBeforeTheRobotHasMoved) {
  SelfReturns returns(RobotModel(), 0.4);
  fly(SeeingRobot(0.85), 0.0, returns);
  EXPECT_EQ(returns.finding(), "");
  expectParts(returns.doubt(), {"0.85", "walls, or else its own parts", "map.range_min_m"});
}

TEST(SelfReturns, AreProvedOnceTheRobotHasMovedItsOwnSizeTwice) {
  for (const double hoop : {0.5, 0.8, 1.2}) {
    SelfReturns returns(RobotModel(), 0.4);
    fly(SeeingRobot(hoop, {1.5, 1.0, 40.0}), 2.0, returns);
    EXPECT_EQ(returns.finding().find("move with the robot"), std::string::npos);
    fly(SeeingRobot(hoop, {1.5, 1.0, 40.0}), 4.0, returns);
    expectParts(returns.finding(), {"move with the robot", "map.range_min_m"});
  }
}

TEST(SelfReturns, AreToldFromAWallRightBesideThem) {
  SelfReturns returns(RobotModel(), 0.4);
  fly(SeeingRobot(0.8), 4.0, returns);
  expectParts(returns.finding(), {"0.80 to 0.8", "move with the robot"});
}

TEST(SelfReturns, BeyondTheSafetyBoxAskForALargerBox) {
  SelfReturns returns(RobotModel(), 0.4);
  fly(SeeingRobot(1.2, {1.5, 1.0, 40.0}), 4.0, returns);
  expectParts(returns.finding(), {"robot.box_m (now [1.1, 1.1, 0.4])"});
}

/// Walls, floor and roof beside which the robot moves stay at the same place of it, too.
TEST(SelfReturns, AreNotSeenInWallsFloorAndRoofThatStayBesideTheRobot) {
  for (const double half_width : {0.6, 0.8, 1.0, 1.5})
    for (const double half_height : {0.25, 0.4, 0.8, 1.5}) {
      SelfReturns returns(RobotModel(), 0.4);
      fly(SeeingRobot(0.0, {half_width, half_height, 40.0}), 6.0, returns);
      EXPECT_EQ(returns.finding(), "") << half_width << " x " << half_height;
    }
}

TEST(SelfReturns, AreGoneOnceTheFilterHoldsThem) {
  RobotModel robot;
  robot.self_filter_boxes_m = {"0", "0", "0", "1.2", "1.2", "0.2"};
  ASSERT_TRUE(robot.problems().empty());
  SelfReturns returns(robot, 0.4);
  fly(SeeingRobot(0.55), 4.0, returns);
  EXPECT_EQ(returns.finding(), "");
}

TEST(SelfReturns, TheRemedyTheyNameIsTheBoxThatRemovesThem) {
  SelfReturns returns(RobotModel(), 0.4);
  fly(SeeingRobot(0.7), 2.0, returns);
  const std::string text = returns.finding();
  ASSERT_NE(text.find("self_filter_boxes_m: ["), std::string::npos) << text;
  const auto from = text.find("self_filter_boxes_m: [") + 22;
  RobotModel robot;
  std::string number;
  for (const char c : text.substr(from, text.find(']', from) - from) + ",") {
    if (c == ',')
      robot.self_filter_boxes_m.push_back(std::exchange(number, ""));
    else if (c != ' ')
      number += c;
  }
  ASSERT_TRUE(robot.problems().empty()) << robot.problems()[0];
  SelfReturns filtered(robot, 0.4);
  fly(SeeingRobot(0.7), 2.0, filtered);
  EXPECT_EQ(filtered.finding(), "") << text;
}

TEST(SelfFilter, RemovesWhatIsInItsBoxesInTheBaseFrameAndKeepsTheOrder) {
  RobotModel robot;
  robot.self_filter_boxes_m = {"0.5", "0", "0",   "0.2", "0.2", "0.2",
                               "0",   "0", "0.5", "1",   "1",   "0.1"};
  const Eigen::Isometry3d T_base_sensor(Eigen::Translation3d(0.0, 0.0, 0.3));
  const Points points{
      {0.5F, 0.0F, -0.3F}, {2.0F, 0.0F, 0.0F}, {0.1F, 0.4F, 0.2F}, {0.5F, 0.0F, 0.0F}};
  EXPECT_EQ(SelfFilter(robot).without(points, T_base_sensor),
            (Points{{2.0F, 0.0F, 0.0F}, {0.5F, 0.0F, 0.0F}}));
}

TEST(SelfFilter, EveryProblemNamesTheParameterAndWhatIsWanted) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"1", "2", "3"}, "has 3 numbers, wanted are six"},
      {{"0", "0", "0", "1", "1", "wide"}, "'wide'"},
      {{"0", "0", "0", "1", "-1", "1"}, "sizes must be above 0"}};
  for (const auto& [numbers, part] : cases) {
    RobotModel robot;
    robot.self_filter_boxes_m = numbers;
    const auto problems = robot.problems();
    ASSERT_GE(problems.size(), 1U) << part;
    expectParts(problems[0], {"self_filter_boxes_m", part});
  }
}

}  // namespace
}  // namespace spelunk
