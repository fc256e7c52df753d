#include "spelunk/sim/world_generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "spelunk/common/contract.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/rock_field.h"
#include "support/mesh_checks.h"
#include "support/temporary_folder.h"
#include "support/walking.h"

namespace spelunk::sim {
namespace {

const Eigen::Vector3d kRobotBox(1.1, 1.1, 0.4);

std::string shipped(const std::string& name) {
  return std::string(SPELUNK_SOURCE_DIR) + "/worlds/" + name + ".yaml";
}

/// Plan, mesh and scene of a shipped world, made once a process.
struct World {
  explicit World(const std::string& name)
      : plan(planWorld(shipped(name))), mesh(meshOf(plan)), scene(mesh) {}
  WorldPlan plan;
  WorldMesh mesh;
  MeshScene scene;

  [[nodiscard]] bool fits(const Eigen::Vector3d& centre) const {
    return scene.boxDistance(centre, kRobotBox, 0.1) > 0.0;
  }
};

const World& world(const std::string& name) {
  static std::map<std::string, World> worlds;
  const auto found = worlds.find(name);
  return found != worlds.end() ? found->second : worlds.try_emplace(name, name).first->second;
}

/// Points every 0.4 m along the middle of all passages, one metre above the floor.
std::vector<Eigen::Vector3d> skeletonOf(const WorldPlan& plan) {
  std::vector<Eigen::Vector3d> points;
  for (const Passage& passage : plan.passages) {
    for (std::size_t i = 1; i < passage.stations.size(); ++i) {
      const Station& a = passage.stations[i - 1];
      const Station& b = passage.stations[i];
      const int steps = static_cast<int>(std::ceil((b.floor - a.floor).norm() / 0.4));
      for (int k = 0; k < steps; ++k)
        points.emplace_back(a.floor + (b.floor - a.floor) * k / steps +
                            Eigen::Vector3d(0.0, 0.0, 1.0));
    }
  }
  return points;
}

/// Share of the skeleton that the robot's box reaches from the start, moving between neighbouring
/// points that are less than 1.2 m apart and checking five places on the way.
double reachedShare(const World& at) {
  std::vector<Eigen::Vector3d> points = skeletonOf(at.plan);
  const std::size_t all = points.size();
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Eigen::Vector3d& p) { return !at.fits(p); }),
               points.end());
  std::sort(points.begin(), points.end(), [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  const auto canMove = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    for (int k = 1; k <= 5; ++k)
      if (!at.fits(a + (b - a) * k / 6.0)) return false;
    return true;
  };
  std::vector<char> reached(points.size(), 0);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((points[i] - at.plan.start.position).norm() > 1.5) continue;
    reached[i] = 1;
    open.push_back(i);
  }
  std::size_t count = open.size();
  while (!open.empty()) {
    const Eigen::Vector3d here = points[open.back()];
    open.pop_back();
    auto low = std::lower_bound(points.begin(), points.end(), here.x() - 1.2,
                                [](const Eigen::Vector3d& p, double x) { return p.x() < x; });
    for (; low != points.end() && low->x() < here.x() + 1.2; ++low) {
      const auto i = static_cast<std::size_t>(low - points.begin());
      if (reached[i] != 0 || (*low - here).norm() > 1.2 || !canMove(here, *low)) continue;
      reached[i] = 1;
      ++count;
      open.push_back(i);
    }
  }
  return static_cast<double>(count) / static_cast<double>(all);
}

struct Expectation {
  const char* name;
  std::uint64_t hash;
  double volume_min_m3;
  double volume_max_m3;
};

class ShippedWorld : public testing::TestWithParam<Expectation> {};

TEST_P(ShippedWorld, IsClosedAndOfTheSizeToBeExpected) {
  const World& at = world(GetParam().name);
  EXPECT_EQ(test::openEdges(at.mesh), 0);
  EXPECT_LT(at.mesh.triangles.size(), 300000U);
  EXPECT_GT(test::enclosedVolume(at.mesh), GetParam().volume_min_m3);
  EXPECT_LT(test::enclosedVolume(at.mesh), GetParam().volume_max_m3);
}

TEST_P(ShippedWorld, HasTheBitsItHasOnEveryMachine) {
  EXPECT_EQ(test::hashOf(world(GetParam().name).mesh), GetParam().hash)
      << "the mesh of '" << GetParam().name << "' changed; raise kWorldGeneratorVersion (now "
      << kWorldGeneratorVersion << ") or caches keep the old one";
}

TEST_P(ShippedWorld, LeavesRoomAtTheStart) {
  const World& at = world(GetParam().name);
  ASSERT_TRUE(at.mesh.start.has_value());
  const Eigen::Vector3d start = at.mesh.start->position;
  EXPECT_GT(at.scene.boxDistance(start, kRobotBox, 1.0), 0.3);
  std::vector<float> down;
  at.scene.castFan(start.cast<float>(), {{0.0F, 0.0F, -1.0F}}, 10.0F, down);
  EXPECT_NEAR(down[0], 1.0F, 0.3F);
}

INSTANTIATE_TEST_SUITE_P(
    All, ShippedWorld,
    testing::Values(Expectation{"long_wall", 1458682609187250659ULL, 12000, 24000},
                    Expectation{"room_and_pillar", 5248636625113724989ULL, 50000, 90000},
                    Expectation{"room_and_pillar_narrow", 9034599414789463336ULL, 20000, 60000},
                    Expectation{"room_and_pillar_wide", 10085471890647589984ULL, 50000, 110000},
                    Expectation{"cave", 5647964739153747146ULL, 12000, 26000},
                    Expectation{"ramps", 18405832082591299727ULL, 4000, 9000},
                    Expectation{"rough", 124908318093271421ULL, 1800, 3500},
                    Expectation{"room", 18286154345773577104ULL, 450, 600},
                    Expectation{"tiny_maze", 3206369154968430270ULL, 800, 1200},
                    Expectation{"room_obs_15", 2893324876787881347ULL, 4500, 5000},
                    Expectation{"room_obs_25", 17622540169993171957ULL, 4400, 5000},
                    Expectation{"room_obs_35", 8261428018733445703ULL, 4300, 5000},
                    Expectation{"mine_96", 6123888148727260855ULL, 8000, 30000},
                    Expectation{"cave_1", 14871390092210456813ULL, 3000, 9000},
                    Expectation{"cave_2", 17158461898159028352ULL, 4000, 12000},
                    Expectation{"mine_225", 5490122944109688925ULL, 40000, 90000}),
    [](const auto& instance) { return std::string(instance.param.name); });

class ShippedMine : public testing::TestWithParam<const char*> {};

TEST_P(ShippedMine, CanBeFlownAlongAlmostAllOfItsPassages) {
  EXPECT_GE(reachedShare(world(GetParam())), 0.95);
}

TEST_P(ShippedMine, IsNowhereNarrowerThanPlanned) {
  const World& at = world(GetParam());
  int narrower = 0;
  int measured = 0;
  for (const Passage& passage : at.plan.passages) {
    for (std::size_t i = 1; i + 1 < passage.stations.size(); ++i) {
      const Eigen::Vector3d axis = passage.stations[i + 1].floor - passage.stations[i - 1].floor;
      const Eigen::Vector3f side =
          Eigen::Vector3d(-axis.y(), axis.x(), 0.0).normalized().cast<float>();
      const Eigen::Vector3d middle = passage.stations[i].floor + Eigen::Vector3d(0.0, 0.0, 1.0);
      std::vector<float> ranges;
      at.scene.castFan(middle.cast<float>(), {side, -side}, 50.0F, ranges);
      const double tolerance = 0.12 * at.plan.cell_m + 0.05;
      const double at_bend = 0.93;  // The wall of a bend runs askew to its station.
      narrower += ranges[0] + ranges[1] < at_bend * passage.stations[i].width - tolerance ? 1 : 0;
      ++measured;
    }
  }
  EXPECT_GT(measured, 30);
  EXPECT_EQ(narrower, 0) << "of " << measured;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedMine,
                         testing::Values("long_wall", "room_and_pillar", "room_and_pillar_narrow",
                                         "room_and_pillar_wide", "cave", "ramps", "rough",
                                         "mine_96", "cave_1", "cave_2"),
                         [](const auto& instance) { return std::string(instance.param); });

/// Whether the way to a hit leads through solid rock.
bool passesRock(const RockField& rock, const Eigen::Vector3f& from,
                const Eigen::Vector3f& direction, float range) {
  for (float along = 0.5F; along < range - 0.7F; along += 0.7F)
    if (rock.at((from + along * direction).cast<double>()) > 0.8) return true;
  return false;
}

TEST(LongWall, LetsNoRaySlipBetweenTwoTriangles) {
  const World& at = world("long_wall");
  const RockField rock(at.plan);
  const std::vector<Eigen::Vector3f> directions = rayDirections(SensorModel{});
  std::vector<float> ranges;
  int slipped = 0;
  // From each of these one ray in 28,800 meets an edge so exactly that careless tests miss both
  // of its triangles.
  for (const auto& [passage, station] : {std::pair{11U, 16U}, {20U, 0U}}) {
    const Eigen::Vector3d floor = at.plan.passages[passage].stations[station].floor;
    const Eigen::Vector3f from = (floor + Eigen::Vector3d(0.013, 0.017, 1.03)).cast<float>();
    at.scene.castFan(from, directions, 50.0F, ranges);
    for (std::size_t i = 0; i < directions.size(); ++i)
      slipped += passesRock(rock, from, directions[i], ranges[i]) ? 1 : 0;
  }
  EXPECT_EQ(slipped, 0);
}

TEST(LongWall, HasTheLengthAndWidthsOfTheDefaultMine) {
  const WorldPlan& plan = world("long_wall").plan;
  EXPECT_GT(passageLength(plan), 1200.0);
  EXPECT_LT(passageLength(plan), 1800.0);
  for (const Passage& passage : plan.passages) {
    for (const Station& station : passage.stations) {
      EXPECT_GE(station.width, 2.0);
      EXPECT_LE(station.width, 4.0);
    }
  }
}

TEST(RoomAndPillar, HasOneNarrowestOpening) {
  const WorldPlan& plan = world("room_and_pillar").plan;
  const auto isSqueeze = [](const Passage& p) { return p.stations[1].width < 1.9; };
  EXPECT_EQ(std::count_if(plan.passages.begin(), plan.passages.end(), isSqueeze), 1);
  const Eigen::Vector3d size = world("room_and_pillar").mesh.bounds().size();
  EXPECT_GT(size.x(), 200.0);
}

/// Height of the ground below a point; far below if there is none within 20 m.
double groundAt(const World& at, const Eigen::Vector3d& from) {
  const auto hit = at.scene.castRay(from, -Eigen::Vector3d::UnitZ(), 20.0);
  return hit ? from.z() - hit->range_m : -1e9;
}

/// The passages that lead from one level to another.
std::vector<Passage> rampsOf(const WorldPlan& plan) {
  std::vector<Passage> ramps;
  for (const Passage& passage : plan.passages)
    if (passage.stations.front().floor.z() != passage.stations.back().floor.z())
      ramps.push_back(passage);
  return ramps;
}

TEST(Ramps, JoinThreeLevelsAtTenToTwentyDegrees) {
  const World& at = world("ramps");
  const std::vector<Passage> ramps = rampsOf(at.plan);
  ASSERT_EQ(ramps.size(), 4U);
  double lowest = 0.0;
  for (const Passage& ramp : ramps) {
    const Eigen::Vector3d down = ramp.stations[4].floor - ramp.stations[2].floor;
    const double degrees = std::atan2(-down.z(), down.head<2>().norm()) * 180.0 / M_PI;
    EXPECT_GE(degrees, 10.0);
    EXPECT_LE(degrees, 20.0);
    for (int k = 0; k <= 20; ++k) {
      const Eigen::Vector3d floor = ramp.stations[2].floor + 0.05 * k * down;
      EXPECT_NEAR(groundAt(at, floor + Eigen::Vector3d(0, 0, 1)), floor.z(), 0.15);
    }
    lowest = std::min(lowest, ramp.stations.back().floor.z());
  }
  EXPECT_EQ(lowest, -12.0);
}

TEST(Ramps, AShaftLeadsStraightDownToTheNextLevel) {
  const World& at = world("ramps");
  ASSERT_EQ(at.plan.halls.size(), 1U);
  const Eigen::Vector3d middle(at.plan.halls[0].floor.x(), at.plan.halls[0].floor.y(), 0.0);
  EXPECT_NEAR(groundAt(at, middle + Eigen::Vector3d(0, 0, 1)), -6.0, 0.15);
  for (double z = 1.0; z > -5.0; z -= 0.25) EXPECT_TRUE(at.fits({middle.x(), middle.y(), z})) << z;
  const Eigen::Vector3d before = middle - Eigen::Vector3d(3.2, 0, -1);
  EXPECT_NEAR(groundAt(at, before), 0.0, 0.15) << "the heading ends before the shaft";
}

TEST(Ramps, AreWalkable) {
  const World& at = world("ramps");
  const Passage ramp = rampsOf(at.plan).front();
  std::vector<Eigen::Vector2d> corners{at.plan.start.position.head<2>()};
  for (const std::size_t k : {0U, 1U, 5U}) corners.emplace_back(ramp.stations[k].floor.head<2>());
  Simulator sim({}, test::walkerModel(), at.mesh, at.plan.start, 1);
  const test::Walked walked = test::walk(sim, corners, 0.5);
  EXPECT_EQ(walked.count.falls, 0);
  EXPECT_EQ(walked.trunk_contacts, 0);
  EXPECT_LT((walked.end.head<2>() - corners.back()).norm(), 0.2);
  EXPECT_NEAR(walked.end.z(), -6.0 + 0.5, 0.2);
}

TEST(TwoShaft, JoinsItsShaftsByAPassageThatNoStraightLineFollows) {
  const World& at = world("two_shaft");
  EXPECT_EQ(test::openEdges(at.mesh), 0);
  for (const Hall& shaft : at.plan.halls) {
    EXPECT_EQ(shaft.size, Eigen::Vector2d(2.5, 2.5));
    for (double z = 0.4; z < 3.6; z += 0.1)
      EXPECT_TRUE(at.fits(shaft.floor + Eigen::Vector3d(0, 0, z))) << z;
  }
  EXPECT_EQ(reachedShare(world("two_shaft")), 0.0) << "the start is high in the shaft";
  for (const Eigen::Vector3d& middle : skeletonOf(at.plan)) EXPECT_TRUE(at.fits(middle));
  const Eigen::Vector3d start = at.mesh.start->position;
  for (const double z : {1.0, 3.2}) {
    const Eigen::Vector3d way = at.plan.halls[1].floor + Eigen::Vector3d(0, 0, z) - start;
    EXPECT_TRUE(at.scene.castRay(start, way.normalized(), way.norm()).has_value());
  }
}

class ObstacleRoom : public testing::TestWithParam<int> {};

TEST_P(ObstacleRoom, HasItsWallsAndGapsThatLetTheRobotThrough) {
  const World& at = world("room_obs_" + std::to_string(GetParam()));
  const std::vector<Pillar>& walls = at.plan.pillars;
  ASSERT_EQ(walls.size(), static_cast<std::size_t>(GetParam()));
  for (std::size_t i = 0; i < walls.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Eigen::Vector2d gap =
          (walls[i].centre - walls[k].centre).cwiseAbs() - 0.5 * (walls[i].size + walls[k].size);
      EXPECT_GE(gap.maxCoeff(), 2.0);
    }
    const Eigen::Vector3d middle(walls[i].centre.x(), walls[i].centre.y(), 2.0);
    EXPECT_FALSE(at.fits(middle));
    const double length = walls[i].size.maxCoeff();
    EXPECT_GE(length, 2.5);
    EXPECT_LE(length, 8.0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ObstacleRoom, testing::Values(15, 25, 35));

TEST(Mine225, ItsShaftsJoinAllLevels) {
  const World& at = world("mine_225");
  const Eigen::Vector3d size = at.mesh.bounds().size();
  EXPECT_NEAR(size.x(), 225.0, 4.0);
  EXPECT_NEAR(size.y(), 117.0, 3.0);
  EXPECT_NEAR(size.z(), 62.0, 2.0);
  ASSERT_EQ(at.plan.halls.size(), 6U);
  for (const Hall& shaft : at.plan.halls)
    for (double z = 0.8; z < 18.0 + 1.2; z += 0.2)
      EXPECT_TRUE(at.fits(shaft.floor + Eigen::Vector3d(0, 0, z))) << z;
}

TEST(Rough, ItsStepsAndHolesAreThere) {
  const World& at = world("rough");
  double highest = 0.0;
  double lowest = 1.0;
  for (const Block& block : at.plan.blocks) {
    const double top = block.centre.z() + 0.5 * block.size.z();
    highest = std::max(highest, top);
    lowest = std::min(lowest, top);
    if (block.size.x() < 1.0 || block.size.y() < 1.0) continue;  // rubble lies on top of rubble
    const double beside = block.size.y() > at.plan.passages[0].stations[0].width ? 0.0 : 0.3;
    const Eigen::Vector3d middle(block.centre.x(), block.centre.y() + beside, 1.2);
    EXPECT_NEAR(groundAt(at, middle), top, 0.1) << middle.transpose();
  }
  EXPECT_EQ(highest, 0.4);
  EXPECT_LT(lowest, 0.12);
  ASSERT_GE(at.plan.pits.size(), 4U);
  for (const Pit& pit : at.plan.pits) {
    EXPECT_GE(pit.size.x(), 0.3);
    EXPECT_LE(pit.size.x(), 1.0);
    EXPECT_NEAR(groundAt(at, pit.top + Eigen::Vector3d(0, 0, 1)), -0.8, 0.15);
  }
}

TEST(Rough, LeavesAWayRoundEveryHoleAndHighStep) {
  const World& at = world("rough");
  for (const double y : {0.0, 18.0}) {
    for (double x = 1.0; x < 59.0; x += 0.2) {
      double widest = 0.0;
      double width = 0.0;
      for (double off = -1.9; off <= 1.9; off += 0.1) {
        const double ground = groundAt(at, {x, y + off, 1.2});
        width = ground > -0.2 && ground < 0.23 ? width + 0.1 : 0.0;
        widest = std::max(widest, width);
      }
      EXPECT_GE(widest, 1.2) << "at x = " << x << ", y = " << y;
    }
  }
}

TEST(Rough, LegsCanCrossRailsAndRubble) {
  const World& at = world("rough");
  Simulator sim({}, test::walkerModel(), at.mesh, at.plan.start, 1);
  const test::Walked walked = test::walk(sim, {{2.5, 0.0}, {20.0, 0.0}}, 0.5);
  EXPECT_EQ(walked.count.falls, 0);
  EXPECT_NEAR(walked.end.x(), 20.0, 0.2);
}

TEST(Rough, AHoleOnTheWayIsAFall) {
  const World& at = world("rough");
  const Pit& pit = at.plan.pits.front();
  const double y = pit.top.y();
  Simulator sim({}, test::walkerModel(), at.mesh, {{pit.top.x() - 2.5, y, 1.0}, 0.0}, 1);
  const test::Walked walked =
      test::walk(sim, {{pit.top.x() - 2.5, y}, {pit.top.x() + 2.5, y}}, 0.5);
  EXPECT_EQ(walked.count.falls, 1);
}

TEST(LongWall, IsWalkable) {
  const World& at = world("long_wall");
  Simulator sim({}, test::walkerModel(), at.mesh, at.plan.start, 1);
  const test::Walked walked = test::walk(sim, {{2.5, 0.0}, {60.0, 0.0}}, 0.5);
  EXPECT_EQ(walked.count.falls, 0);
  EXPECT_EQ(walked.count.slips, 0);
  EXPECT_NEAR(walked.end.x(), 60.0, 0.2);
}

TEST(GenerateWorld, GivesTheSameBytesTwice) {
  const WorldMesh again = generateWorld(shipped("tiny_maze"));
  EXPECT_EQ(test::hashOf(again), test::hashOf(world("tiny_maze").mesh));
  EXPECT_EQ(again.name, "tiny_maze");
}

/// What planning a description says; empty if nothing.
std::string complaintOn(const std::string& text) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("odd.yaml", text);
  try {
    static_cast<void>(generateWorld(path));
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

TEST(GenerateWorld, AnotherSeedIsAnotherWorld) {
  const test::TemporaryFolder folder;
  const auto hashWithSeed = [&](int seed) {
    const std::string text = "kind: maze\nseed: " + std::to_string(seed) + "\n";
    return test::hashOf(generateWorld(folder.write("maze.yaml", text)));
  };
  EXPECT_NE(hashWithSeed(1), hashWithSeed(2));
}

TEST(GenerateWorld, NamesEveryProblemOfADescriptionAndTheKnownNames) {
  const std::string complaint =
      complaintOn("kind: maze\nwidht_m: 3\npitch_m: -1\nrows: many\nseed: 1\n");
  EXPECT_NE(complaint.find("widht_m"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("pitch_m = -1"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("rows = 'many'"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("known names: kind, seed"), std::string::npos) << complaint;
}

TEST(GenerateWorld, RefusesAnUnknownKindAndListsTheKinds) {
  const std::string complaint = complaintOn("kind: volcano\n");
  EXPECT_NE(complaint.find("volcano"), std::string::npos);
  EXPECT_NE(
      complaint.find("drifts, rooms, cave, ramps, rough, room, maze, shafts, walls or levels"),
      std::string::npos);
}

TEST(GenerateWorld, RefusesAMinimumAboveItsMaximum) {
  EXPECT_NE(complaintOn("kind: drifts\nwidth_min_m: 5\nwidth_max_m: 3\n")
                .find("width_min_m must not exceed width_max_m"),
            std::string::npos);
}

TEST(GenerateWorld, RefusesAStartInRock) {
  const std::string complaint = complaintOn("kind: room\nstart: {x_m: 30, y_m: 0}\n");
  EXPECT_NE(complaint.find("start.x_m"), std::string::npos) << complaint;
}

TEST(GenerateWorld, RefusesMoreWallsThanFit) {
  const std::string complaint =
      complaintOn("kind: walls\nwalls: 90\nsize_x_m: 20\nsize_y_m: 20\nstart: {x_m: 3, y_m: 3}\n");
  EXPECT_NE(complaint.find("of 90 walls fit"), std::string::npos) << complaint;
}

TEST(GenerateWorld, NamesAMissingDescription) {
  EXPECT_THROW(static_cast<void>(generateWorld("/no/such/world.yaml")), OutsideError);
}

}  // namespace
}  // namespace spelunk::sim
