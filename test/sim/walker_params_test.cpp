#include "spelunk/sim/walker_params.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <string>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/sim/leg_kinematics.h"
#include "spelunk/sim/simulator.h"
#include "spelunk/sim/walker_urdf.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

const std::string kConfig = std::string(SPELUNK_SOURCE_DIR) + "/config";

TEST(WalkerParams, ShippedOnesAreTheDefaultsAndComplete) {
  ParamTree tree;
  tree.addYamlFile(kConfig + "/robots/walker.yaml");
  const RobotModel robot = loadRobot(tree, "walker", kConfig);
  const SimParams params = readSimParams(tree);
  tree.requireClean();
  const auto shipped = describe("walker", params.walker);
  const auto defaults = describe("walker", WalkerParams{});
  for (std::size_t k = 0; k < shipped.size(); ++k) {
    EXPECT_EQ(shipped[k].value, defaults[k].value) << shipped[k].name;
    EXPECT_TRUE(tree.has(shipped[k].name)) << shipped[k].name;
  }
  EXPECT_EQ(kindOf(robot), RobotKind::kLegged);
  ASSERT_EQ(robot.sensor_models.size(), 3U);
  EXPECT_EQ(robot.sensor_models[0].mount_m.z(), 0.3);
  EXPECT_EQ(robot.sensor_models[0].columns, 1800);
  EXPECT_EQ(robot.sensor_models[1].rows * robot.sensor_models[2].columns, 120 * 160);
  const Vector3d rear = T_base_sensor(robot.sensor_models[2]) * Vector3d::UnitX();
  EXPECT_LT(rear.x(), -1.0) << "the rear camera looks back";
  EXPECT_LT(rear.z(), -0.3) << "and down";
}

/// What is wrong with simulating the robot of a file with one parameter changed.
std::string problemsOf(const std::string& robot_name, const std::string& assignment) {
  ParamTree tree;
  tree.addYamlFile(kConfig + "/robots/" + robot_name + ".yaml");
  if (!assignment.empty()) tree.setAssignment(assignment, "--set");
  const RobotModel robot = loadRobot(tree, robot_name, kConfig);
  static_cast<void>(readSimParams(tree, robot));
  try {
    tree.requireClean();
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

TEST(SimulatedBody, MustFitIntoTheBoxOfTheRobot) {
  const std::string flying = problemsOf("aerial", "sim.body_m=[0.7, 1.2, 0.3]");
  EXPECT_NE(flying.find("robot.box_m = [1.1, 1.1, 0.4]"), std::string::npos) << flying;
  EXPECT_NE(flying.find("sim.body_m = [0.7, 1.2, 0.3]"), std::string::npos) << flying;
  const std::string walking = problemsOf("walker", "walker.trunk_m=[1.3, 0.5, 0.3]");
  EXPECT_NE(walking.find("robot.box_m = [1.2, 0.85, 0.7]"), std::string::npos) << walking;
  EXPECT_NE(walking.find("walker.trunk_m = [1.3, 0.5, 0.3]"), std::string::npos) << walking;
}

TEST(SimulatedBody, FollowsFromTheBoxWhereItIsNotGiven) {
  EXPECT_EQ(problemsOf("aerial", "robot.box_m=[0.6, 0.9, 0.4]"), "");
  EXPECT_EQ(bodyWithin({1.1, 1.1, 0.4}), Eigen::Vector3d(0.7, 0.7, 0.3));
  EXPECT_TRUE((bodyWithin({0.6, 0.9, 0.4}).array() < Eigen::Array3d(0.6, 0.9, 0.4)).all());
}

TEST(SimulatedBody, OfTheShippedRobotsFits) {
  for (const char* name : {"aerial", "inspector", "walker"}) EXPECT_EQ(problemsOf(name, ""), "");
}

TEST(WalkerParams, AreWithoutProblems) { EXPECT_TRUE(WalkerParams{}.problems().empty()); }

std::string onlyProblem(const WalkerParams& params) {
  const auto problems = params.problems();
  return problems.size() == 1 ? problems[0] : std::to_string(problems.size()) + " problems";
}

TEST(WalkerParams, ImpossibleLegsAreNamedWithARemedy) {
  WalkerParams tall;
  tall.stand_height_m = 0.6;
  EXPECT_NE(onlyProblem(tall).find("walker.stand_height_m = 0.6 is out of the legs' reach"),
            std::string::npos)
      << onlyProblem(tall);
  WalkerParams stilts;
  stilts.thigh_m = 1.4;
  stilts.shank_m = 1.5;
  EXPECT_NE(onlyProblem(stilts).find("fold to 0.7"), std::string::npos) << onlyProblem(stilts);
  WalkerParams knees;
  knees.knee_min_deg = 160.0;
  EXPECT_NE(onlyProblem(knees).find("walker.knee_min_deg"), std::string::npos);
  WalkerParams stiff;
  stiff.flexion_max_deg = 5.0;
  EXPECT_NE(onlyProblem(stiff).find("walker.flexion_max_deg"), std::string::npos);
  WalkerParams fat;
  fat.trunk_m.z() = 0.95;
  EXPECT_NE(onlyProblem(fat).find("walker.trunk_m"), std::string::npos);
  WalkerParams hasty;
  hasty.gait = "walk";
  EXPECT_NE(onlyProblem(hasty).find("walker.duty_factor"), std::string::npos);
  WalkerParams crossed;
  crossed.hip_m.y() = -0.1;
  EXPECT_NE(onlyProblem(crossed).find("walker.hip_m"), std::string::npos);
}

TEST(WalkerParams, InertiaIsThatOfABox) {
  WalkerParams params;
  params.trunk_mass_kg = 12.0;
  params.trunk_m = {1.0, 2.0, 3.0};
  EXPECT_LT((trunkInertia(params) - Vector3d(13.0, 10.0, 5.0)).norm(), 1e-12);
}

/// The joints of a URDF as text, enough to walk from the base to the feet.
struct Joint {
  std::string parent;
  Vector3d origin = Vector3d::Zero();
  Vector3d axis = Vector3d::Zero();  ///< Zero if fixed.
  std::string name;
  double lower = 0.0;
  double upper = 0.0;
};

Vector3d vectorOf(const std::string& text) {
  std::istringstream stream(text);
  Vector3d v;
  stream >> v.x() >> v.y() >> v.z();
  return v;
}

std::string attribute(const std::string& text, const std::string& pattern) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

/// By child link.
std::map<std::string, Joint> jointsOf(const std::string& urdf) {
  std::map<std::string, Joint> joints;
  const std::regex element("<joint name=\"([A-Z_a-z]+)\"[^]*?</joint>");
  for (std::sregex_iterator at(urdf.begin(), urdf.end(), element), end; at != end; ++at) {
    const std::string text = at->str();
    Joint joint;
    joint.name = (*at)[1];
    joint.parent = attribute(text, "<parent link=\"([^\"]*)\"");
    joint.origin = vectorOf(attribute(text, "<origin xyz=\"([^\"]*)\""));
    if (const std::string axis = attribute(text, "<axis xyz=\"([^\"]*)\""); !axis.empty()) {
      joint.axis = vectorOf(axis);
      joint.lower = std::stod(attribute(text, "lower=\"([^\"]*)\""));
      joint.upper = std::stod(attribute(text, "upper=\"([^\"]*)\""));
    }
    joints[attribute(text, "<child link=\"([^\"]*)\"")] = joint;
  }
  return joints;
}

Vector3d footByUrdf(const std::map<std::string, Joint>& joints, const std::string& leg,
                    const LegAngles& angles) {
  const std::map<std::string, double> turns{{leg + "_HAA", angles.abduction},
                                            {leg + "_HFE", angles.flexion},
                                            {leg + "_KFE", angles.knee}};
  Vector3d point = Vector3d::Zero();
  std::string link = leg + "_FOOT";
  while (link != "base_link") {
    const Joint& joint = joints.at(link);
    if (joint.axis.norm() > 0.0)
      point = Eigen::AngleAxisd(turns.at(joint.name), joint.axis) * point;
    point += joint.origin;
    link = joint.parent;
  }
  return point;
}

TEST(WalkerUrdf, ItsFeetAreWhereTheKinematicsSays) {
  WalkerParams params;
  params.hip_m = {0.35, 0.11, 0.02};
  params.thigh_m = 0.31;
  const auto joints = jointsOf(walkerUrdf(params, "base_link"));
  ASSERT_EQ(joints.size(), 16U);
  Rng rng(8);
  for (int k = 0; k < 100; ++k)
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const LegAngles angles{rng.uniform(-0.7, 0.7), rng.uniform(-1.0, 1.0),
                             rng.uniform(-2.0, 2.0)};
      EXPECT_LT(
          (footByUrdf(joints, kLegNames[leg], angles) - Leg(params, leg).footAt(angles)).norm(),
          1e-12);
    }
}

TEST(WalkerUrdf, ItsLimitsHoldTheStandingLegs) {
  const WalkerParams params;
  const auto joints = jointsOf(walkerUrdf(params, "base_link"));
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Leg kinematics(params, leg);
    const auto angles =
        kinematics.anglesFor(kinematics.root() - Vector3d(0, 0, params.stand_height_m));
    ASSERT_TRUE(angles);
    const Joint& knee = joints.at(std::string(kLegNames[leg]) + "_SHANK");
    EXPECT_GT(angles->knee, knee.lower);
    EXPECT_LT(angles->knee, knee.upper);
    EXPECT_NEAR(knee.upper - knee.lower, (params.knee_max_deg - params.knee_min_deg) * M_PI / 180.0,
                1e-12);
  }
}

}  // namespace
}  // namespace spelunk::sim
