#include "spelunk/evaluation/exploration_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"
#include "spelunk/evaluation/explored_volume.h"
#include "spelunk/evaluation/reachable_volume.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/world_generator.h"
#include "support/meshes.h"
#include "support/scans.h"

namespace spelunk::evaluation {
namespace {

constexpr double kSpeed_mps = 1.0;

RobotModel robotThatSees(double range_m) {
  RobotModel robot;
  robot.speed_max_mps = kSpeed_mps;
  SensorModel sensor;
  sensor.rows = 24;
  sensor.columns = 240;
  sensor.fov_vertical_deg = 120.0;
  sensor.range_max_m = range_m;
  robot.sensor_models = {sensor};
  return robot;
}

sim::WorldMesh worldOf(const std::string& name) {
  return sim::generateWorld(std::string(SPELUNK_SOURCE_DIR) + "/worlds/" + name + ".yaml");
}

/// What a robot has explored at every whole second of an erratic flight at full speed.
std::vector<double> erraticFlight(const sim::WorldMesh& mesh, const RobotModel& robot, int seconds,
                                  Rng rng) {
  constexpr int kStepsPerSecond = 5;
  constexpr double kRoom_m = 0.3;
  const sim::MeshScene scene(mesh);
  ExploredVolume explored(mesh.bounds(), 0.2, RayChoice::kAll);
  std::vector<double> volumes;
  Eigen::Vector3d position = mesh.start->position;
  Eigen::Vector3d heading = Eigen::Vector3d::UnitX();
  for (int step = 0; step <= seconds * kStepsPerSecond; ++step) {
    explored.add(test::scanFrom(scene, robot.sensor_models.front(), position));
    if (step % kStepsPerSecond == 0) volumes.push_back(explored.volume_m3());
    for (int attempt = 0; attempt < 50; ++attempt) {
      const Eigen::Vector3d next = position + kSpeed_mps / kStepsPerSecond * heading;
      if (scene.distanceTo(next, 1.0) > kRoom_m) {
        position = next;
        break;
      }
      heading =
          Eigen::Vector3d(rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-0.3, 0.3))
              .normalized();
    }
  }
  return volumes;
}

TEST(ExplorationBound, NoFlightExploresMore) {
  const sim::WorldMesh mesh = worldOf("two_shaft");
  for (const double range_m : {2.0, 50.0}) {
    const RobotModel robot = robotThatSees(range_m);
    const std::vector<double> bound = ExplorationBound(mesh, *mesh.start, robot).over(120.0);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const std::vector<double> flown = erraticFlight(mesh, robot, 60, Rng(seed));
      for (std::size_t second = 0; second < flown.size(); ++second)
        ASSERT_LE(flown[second], bound[second]) << "at " << second << " s, range " << range_m;
    }
  }
}

/// Two halls of 8 x 8 x 4 m, 60 m apart, joined by a corridor 2 m wide and high, as one mesh seen
/// from inside: boxes whose common faces are left out.
sim::WorldMesh twoHalls() {
  sim::WorldMesh mesh;
  mesh.name = "two_halls";
  const auto quad = [&mesh](const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
                            const Eigen::Vector3f& v) {
    const int base = static_cast<int>(mesh.vertices.size());
    for (const Eigen::Vector3f& point :
         {corner, Eigen::Vector3f(corner + u), Eigen::Vector3f(corner + u + v),
          Eigen::Vector3f(corner + v)})
      mesh.vertices.push_back(point);
    mesh.triangles.emplace_back(base, base + 1, base + 2);
    mesh.triangles.emplace_back(base, base + 2, base + 3);
  };
  const auto tube = [&quad](float x0, float x1, float half, float top) {
    const Eigen::Vector3f along(x1 - x0, 0.0F, 0.0F);
    quad({x0, -half, 0.0F}, along, {0.0F, 2.0F * half, 0.0F});
    quad({x0, -half, top}, along, {0.0F, 2.0F * half, 0.0F});
    quad({x0, -half, 0.0F}, along, {0.0F, 0.0F, top});
    quad({x0, half, 0.0F}, along, {0.0F, 0.0F, top});
  };
  const auto end = [&quad](float x, bool has_door) {
    quad({x, -4.0F, 2.0F}, {0.0F, 8.0F, 0.0F}, {0.0F, 0.0F, 2.0F});
    quad({x, -4.0F, 0.0F}, {0.0F, 3.0F, 0.0F}, {0.0F, 0.0F, 2.0F});
    quad({x, 1.0F, 0.0F}, {0.0F, 3.0F, 0.0F}, {0.0F, 0.0F, 2.0F});
    if (!has_door) quad({x, -1.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, {0.0F, 0.0F, 2.0F});
  };
  tube(0.0F, 8.0F, 4.0F, 4.0F);
  tube(8.0F, 68.0F, 1.0F, 2.0F);
  tube(68.0F, 76.0F, 4.0F, 4.0F);
  end(0.0F, false);
  end(8.0F, true);
  end(68.0F, true);
  end(76.0F, false);
  mesh.start = Pose{{4.0, 0.0, 1.0}, 0.0};
  return mesh;
}

TEST(ExplorationBound, KnowsThatTheFarHallTakesTime) {
  const sim::WorldMesh mesh = twoHalls();
  const double all = reachableVolume(mesh, mesh.start->position).total_m3;
  const ExplorationBound bound(mesh, *mesh.start, robotThatSees(10.0));
  const std::vector<double> long_enough = bound.over(400.0);
  EXPECT_LT(long_enough[0], 0.62 * all);
  EXPECT_LT(long_enough[30], 0.75 * all);
  EXPECT_NEAR(long_enough[100], all, 1e-6 * all);
  EXPECT_TRUE(std::is_sorted(long_enough.begin(), long_enough.end()));
  // 64 m there and back: with 80 s it cannot have looked into the far hall and be home.
  EXPECT_LT(bound.over(80.0).back(), 0.9 * all);
}

TEST(ExplorationBound, GrowsWithSpeedAndRange) {
  const sim::WorldMesh mesh = twoHalls();
  RobotModel fast = robotThatSees(10.0);
  fast.speed_max_mps = 2.0 * kSpeed_mps;
  const auto slow = ExplorationBound(mesh, *mesh.start, robotThatSees(10.0)).over(60.0);
  const auto twice = ExplorationBound(mesh, *mesh.start, fast).over(60.0);
  const auto blind = ExplorationBound(mesh, *mesh.start, robotThatSees(3.0)).over(60.0);
  for (std::size_t second = 0; second < slow.size(); ++second) {
    EXPECT_GE(twice[second], slow[second]);
    EXPECT_LE(blind[second], slow[second]);
  }
  EXPECT_LT(blind[20], 0.95 * slow[20]);
}

TEST(ExplorationBound, HoldsForWorldsLookedAtMoreCoarselyToo) {
  const sim::WorldMesh mesh = worldOf("two_shaft");
  const RobotModel robot = robotThatSees(50.0);
  BoundParams coarse;
  coarse.volume_m3 = reachableVolume(mesh, mesh.start->position).total_m3 / 8.0;  // twice the edges
  const auto fine = ExplorationBound(mesh, *mesh.start, robot).over(60.0);
  const auto loose = ExplorationBound(mesh, *mesh.start, robot, coarse).over(60.0);
  const std::vector<double> flown = erraticFlight(mesh, robot, 60, Rng(4));
  for (std::size_t second = 0; second < flown.size(); ++second)
    ASSERT_LE(flown[second], loose[second]) << "at " << second << " s";
  EXPECT_NEAR(loose.back(), fine.back(), 1e-6 * fine.back());
}

TEST(ExplorationBound, RefusesAStartInTheRock) {
  const sim::WorldMesh mesh = twoHalls();
  EXPECT_THROW(ExplorationBound(mesh, {{30.0, 30.0, 1.0}, 0.0}, robotThatSees(10.0)), OutsideError);
}

}  // namespace
}  // namespace spelunk::evaluation
