// The two room-and-pillar mines of Dang 2020, Figs. 8 and 9, are what they are described as.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/world_generator.h"

namespace spelunk::sim {
namespace {

const Eigen::Vector3d kRobotBox(1.1, 1.1, 0.4);
constexpr double kCell_m = 0.39;  // less than the box is high: no step leaps a floor

struct Mine {
  explicit Mine(const std::string& name)
      : plan(planWorld(std::string(SPELUNK_SOURCE_DIR) + "/worlds/" + name + ".yaml")),
        mesh(meshOf(plan)),
        scene(mesh) {}

  [[nodiscard]] Eigen::Vector3d placeOf(const std::tuple<int, int, int>& cell) const {
    const auto& [x, y, z] = cell;
    return plan.start.position + kCell_m * Eigen::Vector3d(x, y, z);
  }

  WorldPlan plan;
  WorldMesh mesh;
  MeshScene scene;
};

/// A wall of no thickness across a passage, which no flight crosses.
struct Plug {
  Eigen::Vector3d middle;
  Eigen::Vector3d along;
  [[nodiscard]] bool isCrossed(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    constexpr double kReach_m = 3.0;
    return (a - middle).norm() < kReach_m &&
           (a - middle).dot(along) * (b - middle).dot(along) <= 0.0;
  }
};

using Cells = std::set<std::tuple<int, int, int>>;

/// `reached` and the cells the robot's box reaches from them, neighbour by neighbour; stops beyond
/// `limit` cells.
Cells flooded(const Mine& mine, Cells reached, const std::optional<Plug>& plug, std::size_t limit) {
  using Cell = Cells::value_type;
  std::vector<Cell> open(reached.begin(), reached.end());
  while (!open.empty() && reached.size() <= limit) {
    const Cell here = open.back();
    open.pop_back();
    const auto& [x, y, z] = here;
    for (const Cell& next : {Cell{x + 1, y, z}, Cell{x - 1, y, z}, Cell{x, y + 1, z},
                             Cell{x, y - 1, z}, Cell{x, y, z + 1}, Cell{x, y, z - 1}}) {
      if (reached.count(next) > 0) continue;
      const Eigen::Vector3d place = mine.placeOf(next);
      if (plug && plug->isCrossed(mine.placeOf(here), place)) continue;
      if (mine.scene.boxDistance(place, kRobotBox, 0.05) <= 0.0) continue;
      reached.insert(next);
      open.push_back(next);
    }
  }
  return reached;
}

std::vector<Passage> passagesNarrowerThan(const WorldPlan& plan, double width_m) {
  std::vector<Passage> narrow;
  for (const Passage& passage : plan.passages)
    for (const Station& station : passage.stations)
      if (station.width < width_m) {
        narrow.push_back(passage);
        break;
      }
  return narrow;
}

TEST(NarrowRoomAndPillar, OnePassageOfOnePointEightMetresSeparatesTheStartFromTheRest) {
  const Mine mine("room_and_pillar_narrow");
  const std::vector<Passage> narrow = passagesNarrowerThan(mine.plan, 2.5);
  ASSERT_EQ(narrow.size(), 1U);
  const std::vector<Station>& stations = narrow[0].stations;
  for (const Station& station : stations) EXPECT_DOUBLE_EQ(station.width, 1.8);
  const Eigen::Vector3d along = (stations.back().floor - stations.front().floor).normalized();
  const Station& middle = stations[stations.size() / 2];
  const auto isBeyond = [&](const Cells::value_type& cell) {
    return (mine.placeOf(cell) - middle.floor).dot(along) > kCell_m;
  };
  constexpr std::size_t kCellsMax = 60000;
  const Cells shut =
      flooded(mine, {{0, 0, 0}}, Plug{middle.floor + Eigen::Vector3d(0, 0, 1), along}, kCellsMax);
  EXPECT_GT(shut.size(), 1000U);
  EXPECT_LE(shut.size(), kCellsMax);
  EXPECT_EQ(std::count_if(shut.begin(), shut.end(), isBeyond), 0);
  const std::size_t twice = 2 * shut.size();
  const Cells open = flooded(mine, shut, std::nullopt, twice);
  EXPECT_GT(open.size(), twice) << "most of the mine lies behind the passage";
  EXPECT_GT(std::count_if(open.begin(), open.end(), isBeyond), 1000);
}

TEST(NarrowRoomAndPillar, ThatPassageMeasuresOnePointEightMetresInTheMesh) {
  const Mine mine("room_and_pillar_narrow");
  const Passage squeeze = passagesNarrowerThan(mine.plan, 2.5).at(0);
  const Eigen::Vector3d from = squeeze.stations.front().floor;
  const Eigen::Vector3d way = squeeze.stations.back().floor - from;
  const Eigen::Vector3f side = Eigen::Vector3d(-way.y(), way.x(), 0.0).normalized().cast<float>();
  double narrowest = 1e9;
  for (double share = 0.3; share <= 0.7; share += 0.02) {
    const Eigen::Vector3d middle = from + share * way + Eigen::Vector3d(0, 0, 1.2);
    std::vector<float> ranges;
    mine.scene.castFan(middle.cast<float>(), {side, -side}, 20.0F, ranges);
    narrowest = std::min(narrowest, static_cast<double>(ranges[0] + ranges[1]));
  }
  EXPECT_NEAR(narrowest, 1.8, 0.2);
}

TEST(WideRoomAndPillar, HasNoNarrowPassage) {
  const Mine mine("room_and_pillar_wide");
  EXPECT_TRUE(passagesNarrowerThan(mine.plan, 5.0).empty());
  EXPECT_GT(mine.mesh.bounds().size().head<2>().minCoeff(), 140.0);
}

}  // namespace
}  // namespace spelunk::sim
