#include "spelunk/common/params.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"
#include "spelunk/common/robot_model.h"

namespace spelunk {
namespace {

struct SampleParams {
  double length_m = 1.0;
  int count = 3;
  bool is_on = false;
  std::string label = "a";
  Eigen::Vector3d size_m{1, 2, 3};
  std::vector<std::string> names;
  template <class Visitor>
  void visit(Visitor&& field) {
    field("length_m", length_m, Bounds{0.5, 2.0}, "a length", Audience::kUser);
    field("count", count, Bounds{0, 10}, "a count");
    field("is_on", is_on, Bounds{}, "a switch");
    field("label", label, Bounds{}, "a word");
    field("size_m", size_m, Bounds{0, 9}, "a size");
    field("names", names, Bounds{}, "a list");
  }
};

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

std::string writeFile(const std::string& text) {
  const std::string path = testing::TempDir() + "/params.yaml";
  std::ofstream(path) << text;
  return path;
}

TEST(ParamTree, ReadsEveryTypeFromYamlAndAssignmentsWin) {
  ParamTree tree;
  tree.addYamlFile(
      writeFile("s:\n  length_m: 1.5\n  count: 7\n  is_on: true\n  label: b\n"
                "  size_m: [4, 5, 6]\n  names: [x, y]\n"));
  tree.setAssignment("s.count=8", "--set");
  SampleParams params;
  tree.read("s", params);
  EXPECT_NO_THROW(tree.requireClean());
  EXPECT_EQ(params.length_m, 1.5);
  EXPECT_EQ(params.count, 8);
  EXPECT_TRUE(params.is_on);
  EXPECT_EQ(params.label, "b");
  EXPECT_EQ(params.size_m, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(params.names, (std::vector<std::string>{"x", "y"}));
}

TEST(ParamTree, ReportsAllProblemsInOneMessage) {
  ParamTree tree;
  tree.setAssignment("s.length_m=9", "--set");
  tree.setAssignment("s.count=many", "--set");
  tree.setAssignment("s.lable=b", "--set");
  SampleParams params;
  tree.read("s", params);
  const std::string text = messageOf([&] { tree.requireClean(); });
  EXPECT_NE(text.find("3 problem"), std::string::npos) << text;
  EXPECT_NE(text.find("s.length_m = 9 (--set): must lie in [0.5, 2]"), std::string::npos) << text;
  EXPECT_NE(text.find("s.count = 'many' (--set): must be a whole number"), std::string::npos);
  EXPECT_NE(text.find("did you mean s.label?"), std::string::npos) << text;
}

TEST(ParamTree, BareNameFitsTheFieldOfThatName) {
  ParamTree tree;
  tree.setAssignment("count=4", "--set");
  SampleParams params;
  tree.read("s", params);
  EXPECT_NO_THROW(tree.requireClean());
  EXPECT_EQ(params.count, 4);
}

TEST(ParamTree, BareNameThatFitsTwoFieldsIsRefused) {
  ParamTree tree;
  tree.setAssignment("count=4", "--set");
  SampleParams params;
  tree.read("s", params);
  tree.read("t", params);
  const std::string text = messageOf([&] { tree.requireClean(); });
  EXPECT_NE(text.find("write one of s.count t.count"), std::string::npos) << text;
}

TEST(ParamTree, NotANumberIsRefused) {
  ParamTree tree;
  tree.setAssignment("s.length_m=nan", "--set");
  SampleParams params;
  tree.read("s", params);
  EXPECT_THROW(tree.requireClean(), OutsideError);
  EXPECT_EQ(params.length_m, 1.0);
}

TEST(ParamTree, NumbersAreReadWholeOrNotAtAll) {
  const auto isRead = [](const std::string& text) {
    ParamTree tree;
    tree.setAssignment("s.size_m=[" + text + ", 1, 1]", "--set");
    SampleParams params;
    tree.read("s", params);
    try {
      tree.requireClean();
      return true;
    } catch (const OutsideError&) {
      return false;
    }
  };
  for (const char* good : {"1", "+2", ".5", "1e-3", " 8.0 "}) EXPECT_TRUE(isRead(good)) << good;
  for (const char* bad : {"", "-", "1m", "1 2", "e5", "--1", "0x"})
    EXPECT_FALSE(isRead(bad)) << bad;
}

TEST(ParamTree, NamesAMissingOrBrokenFile) {
  ParamTree tree;
  EXPECT_NE(messageOf([&] { tree.addYamlFile("/none/such.yaml"); }).find("/none/such.yaml"),
            std::string::npos);
  EXPECT_NE(messageOf([&] { tree.addYamlFile(writeFile("a: [1, 2")); }).find("not valid YAML"),
            std::string::npos);
  EXPECT_THROW(tree.setAssignment("no-equals", "--set"), OutsideError);
}

TEST(RobotModel, ShippedRobotsAndSensorsLoadClean) {
  const std::string config = std::string(SPELUNK_SOURCE_DIR) + "/config";
  ParamTree tree;
  tree.addYamlFile(config + "/robots/aerial.yaml");
  const RobotModel robot = loadRobot(tree, "aerial", config);
  EXPECT_NO_THROW(tree.requireClean());
  EXPECT_EQ(robot.box_m, Eigen::Vector3d(1.1, 1.1, 0.4));
  ASSERT_EQ(robot.sensor_models.size(), 1u);
  EXPECT_EQ(robot.sensor_models[0].columns, 1800);
}

TEST(Throttle, LetsTheSameMessageThroughOnceAPeriod) {
  Throttle throttle(5.0);
  EXPECT_TRUE(throttle.allows("a", 0.0));
  EXPECT_FALSE(throttle.allows("a", 4.9));
  EXPECT_TRUE(throttle.allows("b", 4.9));
  EXPECT_TRUE(throttle.allows("a", 5.0));
  EXPECT_TRUE(throttle.allows("a", 1.0)) << "a clock that jumped back must not silence it";
}

}  // namespace
}  // namespace spelunk
