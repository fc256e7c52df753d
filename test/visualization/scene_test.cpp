#include "spelunk/visualization/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "spelunk/common/contract.h"

namespace spelunk::visualization {
namespace {

Element strip(std::vector<Eigen::Vector3d> points) {
  Element line;
  line.layer = "line";
  line.shape = Shape::kLineStrip;
  line.points = std::move(points);
  line.colours = {{1.0F, 0.5F, 0.0F, 1.0F}};
  return line;
}

std::string readAll(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Scene, KeepsElementsByLayerInOrder) {
  Scene scene;
  scene.add(strip({{0, 0, 0}, {1, 0, 0}}));
  Element other = strip({{5, 0, 0}, {6, 0, 0}});
  other.layer = "other";
  scene.add(other);
  scene.add(strip({{2, 0, 0}, {3, 0, 0}}));
  const auto lines = scene.layer("line");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]->points[0].x(), 0.0);
  EXPECT_EQ(lines[1]->points[0].x(), 2.0);
  EXPECT_TRUE(scene.layer("nothing").empty());
}

TEST(Scene, LeavesOutWhatCannotBeShown) {
  Scene scene;
  scene.add(strip({}));
  scene.add(strip({{0, 0, 0}, {std::nan(""), 0, 0}}));
  scene.add(strip({{0, 0, 0}, {0, std::numeric_limits<double>::infinity(), 0}}));
  EXPECT_TRUE(scene.elements().empty());
}

TEST(Scene, RefusesColoursThatDoNotFitThePoints) {
  Scene scene;
  Element line = strip({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  line.colours.resize(2);
  EXPECT_THROW(scene.add(line), Precondition);
  line.colours.resize(3);
  EXPECT_NO_THROW(scene.add(line));
  line.shape = Shape::kLineList;
  EXPECT_THROW(scene.add(line), Precondition);
}

TEST(Scene, MarksScaleAndBoxesDoNot) {
  Scene scene;
  scene.add(strip({{0, 0, 0}, {4, 0, 0}}));
  Element box = strip({{1, 2, 3}});
  box.shape = Shape::kBox;
  scene.add(box);
  const Scene scaled = withMarksScaled(scene, 0.25);
  ASSERT_EQ(scaled.elements().size(), 2U);
  EXPECT_EQ(scaled.elements()[0].size_m, 0.25 * scene.elements()[0].size_m);
  EXPECT_EQ(scaled.elements()[0].points[1].x(), 4.0) << "things stay where they are";
  EXPECT_EQ(scaled.elements()[1].extents_m, box.extents_m);
  EXPECT_THROW((void)withMarksScaled(scene, 0.0), Precondition);
}

TEST(HeatColour, GoesFromBlueOverGreenToRed) {
  EXPECT_GT(heatColour(0.0).b, 0.9F);
  EXPECT_LT(heatColour(0.0).r, 0.1F);
  EXPECT_GT(heatColour(0.45).g, 0.9F);
  EXPECT_GT(heatColour(1.0).r, 0.9F);
  EXPECT_LT(heatColour(1.0).g, 0.1F);
  EXPECT_EQ(heatColour(7.0).r, heatColour(1.0).r);
  EXPECT_EQ(heatColour(std::nan("")).b, heatColour(0.0).b);
}

TEST(ScenePly, WritesVerticesAndEdges) {
  Scene scene;
  scene.add(strip({{0, 0, 0}, {1, 0, 0}, {1, 2, 3}}));
  Element box = strip({{0, 0, 0}});
  box.shape = Shape::kBox;
  scene.add(box);
  Element text = strip({{0, 0, 0}});
  text.shape = Shape::kText;
  scene.add(text);
  const std::string path = ::testing::TempDir() + "scene_test.ply";
  savePly(scene, path);
  const std::string ply = readAll(path);
  EXPECT_NE(ply.find("element vertex 11\n"), std::string::npos) << "3 of the line, 8 corners";
  EXPECT_NE(ply.find("element edge 14\n"), std::string::npos) << "2 of the line, 12 of the box";
  EXPECT_NE(ply.find("1 2 3 255 128 0\n"), std::string::npos);
  EXPECT_NE(ply.find("\n1 2\n"), std::string::npos) << "the line's second edge";
}

TEST(ScenePly, LineListJoinsPairsOnly) {
  Scene scene;
  Element list = strip({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  list.shape = Shape::kLineList;
  scene.add(list);
  const std::string path = ::testing::TempDir() + "scene_list_test.ply";
  savePly(scene, path);
  EXPECT_NE(readAll(path).find("element edge 2\n"), std::string::npos);
}

TEST(ScenePly, NamesThePathItCannotWrite) {
  try {
    savePly(Scene(), "/nowhere/at/all.ply");
    FAIL() << "no error";
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all.ply"), std::string::npos);
  }
}

}  // namespace
}  // namespace spelunk::visualization
