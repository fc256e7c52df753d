#include "spelunk/ros/convert_robot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "spelunk/ros/robot_description.h"

namespace spelunk::bridge {
namespace {

int countOf(const std::string& part, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(ConvertJoints, KeepsNamesAnglesAndTime) {
  const auto message = toMsg(sim::JointState{{"LF_HAA", "LF_HFE"}, {0.1, -0.7}}, ros::Time(2.5));
  EXPECT_EQ(message.header.stamp, ros::Time(2.5));
  EXPECT_EQ(message.name, (std::vector<std::string>{"LF_HAA", "LF_HFE"}));
  EXPECT_EQ(message.position, (std::vector<double>{0.1, -0.7}));
  EXPECT_TRUE(message.velocity.empty());
}

TEST(ConvertDrive, TakesForwardLeftAndTurn) {
  geometry_msgs::Twist message;
  message.linear.x = 0.4;
  message.linear.y = -0.1;
  message.linear.z = 9.0;
  message.angular.z = 0.3;
  const auto command = fromMsg(message);
  ASSERT_TRUE(command.value) << command.problem;
  EXPECT_EQ(command.value->forward_mps, 0.4);
  EXPECT_EQ(command.value->sideways_mps, -0.1);
  EXPECT_EQ(command.value->yaw_rate_radps, 0.3);
}

TEST(ConvertDrive, RefusesWhatIsNotFiniteAnywhere) {
  for (int part = 0; part < 6; ++part) {
    geometry_msgs::Twist message;
    double* const numbers[] = {&message.linear.x,  &message.linear.y,  &message.linear.z,
                               &message.angular.x, &message.angular.y, &message.angular.z};
    *numbers[part] = part % 2 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                   : std::numeric_limits<double>::infinity();
    const auto command = fromMsg(message);
    EXPECT_FALSE(command.value) << part;
    EXPECT_NE(command.problem.find("not finite"), std::string::npos);
  }
}

TEST(ConvertFeet, AreTurnedAndTiltedWithTheBody) {
  RobotState state;
  state.pose.position = {10.0, 0.0, 1.0};
  state.orientation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()) *
                      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY());
  const auto marks = marksOf({{"LF", {0.3, 0.2, -0.5}, true}, {"RH", {0.0, 0.0, -0.5}, false}},
                             T_world_body(state));
  ASSERT_EQ(marks.size(), 2U);
  // Pitched nose down: down in the body is back, and back is -y after the turn to the left.
  EXPECT_TRUE(marks[0].position.isApprox(Eigen::Vector3d(9.8, -0.5, 0.7), 1e-9))
      << marks[0].position.transpose();
  EXPECT_TRUE(marks[0].is_standing);
  EXPECT_FALSE(marks[1].is_standing);
}

TEST(RobotDescription, OfAnAerialRobotIsOneLinkWithItsRotors) {
  RobotModel robot;
  sim::SimParams params;
  params.rotors = 6;
  const std::string urdf = robotDescription(robot, params, "hull");
  EXPECT_EQ(countOf("<cylinder", urdf), 6);
  EXPECT_EQ(countOf("<box", urdf), 1);
  EXPECT_EQ(countOf("<link name=\"hull\">", urdf), 1);
  EXPECT_EQ(countOf("<joint", urdf), 0);
}

TEST(RobotDescription, OfAWalkerHasItsTwelveJoints) {
  RobotModel robot;
  robot.kind = "legged";
  const std::string urdf = robotDescription(robot, sim::SimParams(), "base_link");
  EXPECT_EQ(countOf("type=\"revolute\"", urdf), 12);
}

}  // namespace
}  // namespace spelunk::bridge
