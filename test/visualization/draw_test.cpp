#include "spelunk/visualization/draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace spelunk::visualization {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

planners::PlannerGraph smallGraph() {
  planners::GraphLayer local;
  local.name = "local";
  local.vertices = {{{0, 0, 0}, 0.0, false}, {{1, 0, 0}, 5.0, false}, {{2, 0, 0}, 10.0, true}};
  local.edges = {{0, 1}, {1, 2}, {2, 99}};
  return {{local}};
}

TEST(DrawGraph, DrawsEachEdgeOnceAndSkipsBrokenOnes) {
  Scene scene;
  drawGraph(smallGraph(), scene);
  const auto edges = scene.layer("graph/local");
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(edges[0]->points.size(), 4U);
}

TEST(DrawGraph, ColoursGainsRelativeToTheLargest) {
  Scene scene;
  drawGraph(smallGraph(), scene);
  const auto gains = scene.layer("gain/local");
  ASSERT_EQ(gains.size(), 1U);
  ASSERT_EQ(gains[0]->points.size(), 2U) << "the vertex without gain has no mark";
  EXPECT_EQ(gains[0]->colours[1].r, heatColour(1.0).r);
  EXPECT_EQ(gains[0]->colours[0].g, heatColour(0.5).g);
}

TEST(DrawGraph, MarksFrontiers) {
  Scene scene;
  drawGraph(smallGraph(), scene);
  const auto frontiers = scene.layer("frontier/local");
  ASSERT_EQ(frontiers.size(), 1U);
  ASSERT_EQ(frontiers[0]->points.size(), 1U);
  EXPECT_EQ(frontiers[0]->points[0].x(), 2.0);
}

TEST(DrawPaths, ColourTellsTheKind) {
  const Path path{{{0, 0, 1}, 0.0}, {{3, 0, 1}, 0.0}};
  Scene local;
  Scene home;
  drawActivePath(path, planners::PathKind::kLocal, local);
  drawActivePath(path, planners::PathKind::kHome, home);
  ASSERT_EQ(local.layer("path").size(), 2U) << "the line and its end";
  EXPECT_NE(local.layer("path")[0]->colours[0].g, home.layer("path")[0]->colours[0].g);
  EXPECT_EQ(local.layer("path")[1]->points[0].x(), 3.0);
}

TEST(DrawPaths, ShortPathsDrawNoLine) {
  Scene scene;
  drawWayHome({}, scene);
  drawTrail({{{0, 0, 0}, 0.0}}, scene);
  drawActivePath({}, planners::PathKind::kLocal, scene);
  EXPECT_TRUE(scene.elements().empty());
}

TEST(DrawBounds, ClosesOpenSidesWhereTheShownRegionEnds) {
  const AxisAlignedBox shown{{-10, -10, -1}, {10, 10, 5}};
  AxisAlignedBox bounds;
  bounds.min.x() = -3.0;
  bounds.max.x() = 20.0;
  Scene scene;
  drawBounds(bounds, shown, scene);
  const auto lines = scene.layer("bounds");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0]->points.size(), 24U) << "twelve edges";
  double x_max = -kInf;
  double z_max = -kInf;
  for (const Eigen::Vector3d& point : lines[0]->points) {
    x_max = std::max(x_max, point.x());
    z_max = std::max(z_max, point.z());
  }
  EXPECT_EQ(x_max, 20.0);
  EXPECT_EQ(z_max, 5.0);
}

TEST(DrawBounds, NothingToDrawWithoutBounds) {
  Scene scene;
  drawBounds(AxisAlignedBox{}, {{-1, -1, -1}, {1, 1, 1}}, scene);
  EXPECT_TRUE(scene.elements().empty());
}

TEST(DrawZones, DrawsPrismWithItsName) {
  NoGoZone zone{"shaft", {{0, 0}, {2, 0}, {2, 2}}, -kInf, 4.0};
  Scene scene;
  drawZones({zone}, {{-5, -5, -2}, {5, 5, 9}}, scene);
  const auto elements = scene.layer("no_go_zones");
  ASSERT_EQ(elements.size(), 2U);
  EXPECT_EQ(elements[0]->points.size(), 18U) << "two rings of three and three uprights";
  const auto below = [](const auto& a, const auto& b) { return a.z() < b.z(); };
  const auto [low, high] =
      std::minmax_element(elements[0]->points.begin(), elements[0]->points.end(), below);
  EXPECT_EQ(low->z(), -2.0);
  EXPECT_EQ(high->z(), 4.0);
  EXPECT_EQ(elements[1]->text, "shaft");
}

TEST(DrawRobot, BoxHasTheRobotsSizeAndHeadingPointsAhead) {
  Scene scene;
  drawRobot({{1, 2, 3}, M_PI / 2}, {1.0, 1.0, 0.4}, scene);
  const auto elements = scene.layer("robot");
  ASSERT_EQ(elements.size(), 2U);
  EXPECT_EQ(elements[0]->extents_m.z(), 0.4);
  EXPECT_GT(elements[1]->points[1].y(), 2.5);
  EXPECT_NEAR(elements[1]->points[1].x(), 1.0, 1e-9);
}

TEST(DrawRemaining, SaysWhyEachPlaceWasLeft) {
  Scene scene;
  drawRemaining({{{1, 0, 0}, 3.0, "too narrow"}, {{2, 0, 0}, 3.0, ""}}, scene);
  EXPECT_EQ(scene.layer("remaining").size(), 3U) << "two marks, one text";
}

TEST(StatusText, NamesStateFiguresAndReason) {
  mission::MissionStatus status;
  status.state = mission::MissionState::kReposition;
  status.time_s = 61.4;
  status.known_volume_m3 = 1234.0;
  status.remaining_s = 800.0;
  status.margin_s = 650.0;
  status.reason = "the local graph holds nothing above the threshold so the robot goes elsewhere";
  const std::string text = statusText(status);
  for (const char* part : {"Reposition", "61 s", "1234 m3", "endurance 800 s", "margin 650 s"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
  std::size_t longest = 0;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    longest = std::max(longest, end - from);
    from = end + 1;
  }
  EXPECT_LE(longest, 60U) << text;
}

TEST(StatusText, EndReasonWinsOverTheNewestReason) {
  mission::MissionStatus status;
  status.reason = "old";
  status.end_reason = "explored";
  EXPECT_NE(statusText(status).find("explored"), std::string::npos);
  EXPECT_EQ(statusText(status).find("old"), std::string::npos);
}

TEST(DrawGraph, ShowsWhatIsExploredGreenAndWhatIsNotRed) {
  planners::GraphLayer layer{"reachability", {}, {{0, 1}}};
  layer.vertices.push_back({{0.0, 0.0, 0.0}, 0.0, true});
  layer.vertices.push_back({{1.0, 0.0, 0.0}, 0.0, false});
  Scene scene;
  drawGraph({{layer}}, scene);
  const auto drawn = scene.layer("explored/reachability");
  ASSERT_EQ(drawn.size(), 1U);
  ASSERT_EQ(drawn[0]->colours.size(), 2U);
  EXPECT_GT(drawn[0]->colours[0].r, drawn[0]->colours[0].g);
  EXPECT_GT(drawn[0]->colours[1].g, drawn[0]->colours[1].r);
  EXPECT_TRUE(scene.layer("frontier/reachability").empty());
  EXPECT_EQ(scene.layer("graph/reachability").size(), 1U);
}

TEST(DrawNavigation, SplitsThePathWhereKnownSpaceEnds) {
  navigation::NavigationAnswer answer;
  answer.path = {{{0.0, 0.0, 0.0}, 0.0}, {{10.0, 0.0, 0.0}, 0.0}};
  answer.known_length_m = 4.0;
  answer.trees = {{{0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}}, {{0, 1}}};
  Scene scene;
  drawNavigation(answer, scene);
  EXPECT_EQ(scene.layer("navigation/trees")[0]->points.size(), 2U);
  EXPECT_EQ(scene.layer("navigation/known")[0]->points.back(), Eigen::Vector3d(4.0, 0.0, 0.0));
  EXPECT_EQ(scene.layer("navigation/unknown")[0]->points.front(), Eigen::Vector3d(4.0, 0.0, 0.0));
  answer.known_length_m = 10.0;
  Scene known;
  drawNavigation(answer, known);
  EXPECT_TRUE(known.layer("navigation/unknown").empty());
}

}  // namespace
}  // namespace spelunk::visualization
