#include "spelunk/map/volumetric_gain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "map/template_rays.h"
#include "map_worlds.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

SensorModel sensorOf(double horizontal_deg, double vertical_deg, double range_m) {
  SensorModel sensor;
  sensor.fov_horizontal_deg = horizontal_deg;
  sensor.fov_vertical_deg = vertical_deg;
  sensor.gain_range_m = range_m;
  return sensor;
}

AxisAlignedBox cube(double half_m) {
  return {Eigen::Vector3d::Constant(-half_m), Eigen::Vector3d::Constant(half_m)};
}

/// The same voxel lists looked up one by one in the OcTree.
VolumetricGain plainGain(const octomap::OcTree& tree, const LocalWindow& window,
                         const std::vector<SensorModel>& sensors, const Eigen::Vector3d& position,
                         double yaw, const AxisAlignedBox& bounds, GainCounting counting) {
  VolumetricGain gain;
  std::set<std::tuple<int, int, int>> seen;
  for (const SensorModel& sensor : sensors) {
    const TemplateRays rays(sensor, window.resolution());
    const Eigen::Vector3d origin =
        position + Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * sensor.mount_m;
    const VoxelIndex start = window.indexOf(origin);
    const auto counts = [&](const VoxelIndex& at) {
      const VoxelIndex local = at - window.origin();
      return (local.array() >= 0).all() && (local.array() < window.size().array()).all() &&
             bounds.contains(window.centreOf(at));
    };
    const TemplateRays::Heading heading = rays.headingAt(yaw);
    for (std::size_t i = 0; i < heading.count && counts(start); ++i) {
      const auto& ray = rays.rays()[(heading.first + i) % rays.rays().size()];
      for (std::uint32_t k = ray.begin; k < ray.end; ++k) {
        const auto& step = rays.steps()[k];
        const VoxelIndex at = start + VoxelIndex(step[0], step[1], step[2]);
        if (!counts(at)) break;
        const Occupancy status = statusIn(tree, at);
        const bool is_new =
            counting == GainCounting::kPerRay || seen.insert({at.x(), at.y(), at.z()}).second;
        if (is_new) {
          gain.unknown_voxels += status == Occupancy::kUnknown ? 1 : 0;
          gain.free_voxels += status == Occupancy::kFree ? 1 : 0;
          gain.occupied_voxels += status == Occupancy::kOccupied ? 1 : 0;
        }
        if (status == Occupancy::kOccupied) break;
      }
    }
  }
  return gain;
}

void expectEqual(const VolumetricGain& a, const VolumetricGain& b) {
  EXPECT_EQ(a.unknown_voxels, b.unknown_voxels);
  EXPECT_EQ(a.free_voxels, b.free_voxels);
  EXPECT_EQ(a.occupied_voxels, b.occupied_voxels);
}

class GainIn : public testing::TestWithParam<GainCounting> {
 protected:
  GainIn() : map_(hallMap(MapParams{}, 4, 1500, 7)) {}

  void expectEqualToTree(const std::vector<SensorModel>& sensors, const AxisAlignedBox& region,
                         const AxisAlignedBox& bounds) {
    const LocalWindow window(*map_.freeze(), region);
    const GainEvaluator evaluator(sensors, 0.2, GetParam());
    Rng rng(4);
    long total = 0;
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3d position(rng.uniform(-8, 8), rng.uniform(-3, 3), rng.uniform(0, 2));
      const double yaw = rng.uniform(-7.0, 7.0);
      const VolumetricGain gain = evaluator.evaluate(window, position, yaw, bounds);
      expectEqual(gain,
                  plainGain(map_.octree(), window, sensors, position, yaw, bounds, GetParam()));
      EXPECT_DOUBLE_EQ(gain.unknown_m3, gain.unknown_voxels * 0.2 * 0.2 * 0.2);
      total += gain.unknown_voxels;
    }
    EXPECT_GT(total, 1000);
  }

  OccupancyMap map_;
};

TEST_P(GainIn, EqualsLookUpsForLidar) {
  expectEqualToTree({sensorOf(360, 30, 20)}, cube(32.0), AxisAlignedBox{});
}

TEST_P(GainIn, EqualsLookUpsWhereWindowCutsRays) {
  expectEqualToTree({sensorOf(360, 30, 20)}, {{-10, -5, -1}, {6, 8, 4}}, AxisAlignedBox{});
}

TEST_P(GainIn, EqualsLookUpsWhereBoundsCutRays) {
  expectEqualToTree({sensorOf(360, 30, 12)}, cube(25.0), {{-9.5, -4.7, -2.33}, {9.1, 6, 3.1}});
}

TEST_P(GainIn, EqualsLookUpsForSeveralMountedSensors) {
  SensorModel camera = sensorOf(90, 60, 8);
  camera.kind = "depth_camera";
  camera.mount_m = {0.3, 0.1, -0.1};
  camera.mount_yaw_deg = 180.0;
  SensorModel tilted = sensorOf(80, 40, 10);
  tilted.mount_pitch_deg = 30.0;
  tilted.gain_resolution_deg = 8.0;
  expectEqualToTree({sensorOf(360, 30, 15), camera, tilted}, cube(28.0), AxisAlignedBox{});
}

INSTANTIATE_TEST_SUITE_P(Countings, GainIn,
                         testing::Values(GainCounting::kPerRay, GainCounting::kDistinct));

TEST(VolumetricGain, EmptyMapIsAllUnknownToTheRange) {
  OccupancyMap map{MapParams{}};
  const LocalWindow window(*map.freeze(), cube(12.0));
  const GainEvaluator rays({sensorOf(360, 30, 10)}, 0.2, GainCounting::kPerRay);
  const GainEvaluator voxels({sensorOf(360, 30, 10)}, 0.2, GainCounting::kDistinct);
  const VolumetricGain per_ray = rays.evaluate(window, {0.1, 0.1, 0.1}, 0.0, AxisAlignedBox{});
  const VolumetricGain distinct = voxels.evaluate(window, {0.1, 0.1, 0.1}, 0.0, AxisAlignedBox{});
  EXPECT_EQ(per_ray.free_voxels + per_ray.occupied_voxels, 0);
  // 72 x 7 rays of 50 voxels length cross between 50 and 50 * sqrt(3) voxels each.
  EXPECT_GT(per_ray.unknown_voxels, 504 * 49);
  EXPECT_LT(per_ray.unknown_voxels, 504 * 87);
  EXPECT_LT(distinct.unknown_voxels, per_ray.unknown_voxels);
  EXPECT_GT(distinct.unknown_voxels, per_ray.unknown_voxels / 2);
}

TEST(VolumetricGain, ConesHoldTheVolumeOfTheFieldOfView) {
  OccupancyMap empty{MapParams{}};
  const LocalWindow window(*empty.freeze(), cube(12.0));
  const auto coneGain = [](const LocalWindow& in, double degrees) {
    SensorModel sensor = sensorOf(360, 30, 10);
    sensor.gain_resolution_deg = degrees;
    return GainEvaluator({sensor}, 0.2, GainCounting::kCone)
        .evaluate(in, {0.1, 0.1, 0.1}, 0.0, AxisAlignedBox{})
        .unknown_m3;
  };
  for (const double degrees : {5.0, 2.5}) {
    const double half = (15.0 + 0.5 * degrees) * M_PI / 180.0;  // a row sees half a row beyond it
    const double field = 2.0 * M_PI * 2.0 * std::sin(half) * 1000.0 / 3.0;
    EXPECT_NEAR(coneGain(window, degrees), field, 0.01 * field) << degrees;
  }
  OccupancyMap half{MapParams{}};
  half.markFree({{-12.0, -12.0, -4.0}, {0.1, 12.0, 4.0}});
  const LocalWindow half_known(*half.freeze(), cube(12.0));
  EXPECT_NEAR(coneGain(half_known, 5.0), 0.5 * coneGain(window, 5.0), 0.03 * coneGain(window, 5.0));
}

/// Cones step by step: voxels looked up one by one, volumes added one by one.
VolumetricGain plainConeGain(const LocalWindow& window, const std::vector<SensorModel>& sensors,
                             const Eigen::Vector3d& position, double yaw,
                             const AxisAlignedBox& bounds, float depth_voxels) {
  VolumetricGain gain;
  for (const SensorModel& sensor : sensors) {
    const TemplateRays rays(sensor, window.resolution());
    const VoxelIndex start = window.indexOf(
        position + Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * sensor.mount_m);
    const auto counts = [&](const VoxelIndex& at) {
      const VoxelIndex local = at - window.origin();
      return (local.array() >= 0).all() && (local.array() < window.size().array()).all() &&
             bounds.contains(window.centreOf(at));
    };
    const TemplateRays::Heading heading = rays.headingAt(yaw);
    for (std::size_t i = 0; i < heading.count && counts(start); ++i) {
      const auto& ray = rays.rays()[(heading.first + i) % rays.rays().size()];
      const float* volumes = rays.coneVolumes().data() + ray.cone;
      const float* lengths = rays.coneLengths().data() + ray.cone;
      float limit = std::numeric_limits<float>::infinity();
      for (std::uint32_t k = 0; k < ray.end - ray.begin; ++k) {
        const auto& step = rays.steps()[ray.begin + k];
        const VoxelIndex at = start + VoxelIndex(step[0], step[1], step[2]);
        if (!counts(at)) break;
        const Occupancy status = window.at(at);
        gain.free_voxels += status == Occupancy::kFree ? 1 : 0;
        gain.occupied_voxels += status == Occupancy::kOccupied ? 1 : 0;
        if (status == Occupancy::kFree) continue;
        if (status == Occupancy::kOccupied) break;
        limit = std::min(limit, lengths[k] + depth_voxels);
        if (lengths[k] >= limit) break;
        ++gain.unknown_voxels;
        gain.unknown_m3 += static_cast<double>(volumes[k + 1]) - static_cast<double>(volumes[k]);
      }
    }
  }
  gain.unknown_m3 *= std::pow(window.resolution(), 3);
  return gain;
}

TEST(VolumetricGain, ConesEqualTheirStepsAddedOneByOne) {
  OccupancyMap map = hallMap(MapParams{}, 4, 1500, 7);
  const LocalWindow window(*map.freeze(), cube(32.0));
  SensorModel camera = sensorOf(90, 60, 8);
  camera.mount_yaw_deg = 180.0;
  camera.mount_m = {0.3, 0.1, -0.1};
  Rng rng(5);
  double total_m3 = 0.0;
  for (const double depth_m : {0.5, 3.0, 100.0}) {
    for (const std::vector<SensorModel>& sensors :
         {std::vector{sensorOf(360, 30, 20)}, std::vector{sensorOf(360, 80, 25), camera}}) {
      const GainEvaluator evaluator(sensors, 0.2, GainCounting::kCone, depth_m);
      for (int i = 0; i < 20; ++i) {
        // Some start in unknown space, where sums of small and large volumes are rounded.
        const Eigen::Vector3d position(rng.uniform(-14, 14), rng.uniform(-7, 7),
                                       rng.uniform(-1, 4));
        const double yaw = rng.uniform(-7.0, 7.0);
        const AxisAlignedBox bounds =
            i % 2 == 0 ? AxisAlignedBox{} : AxisAlignedBox{{-15, -7.7, -3.3}, {20, 9.1, 6.1}};
        const VolumetricGain gain = evaluator.evaluate(window, position, yaw, bounds);
        const VolumetricGain plain = plainConeGain(window, sensors, position, yaw, bounds,
                                                   static_cast<float>(depth_m / 0.2));
        expectEqual(gain, plain);
        EXPECT_EQ(gain.unknown_m3, plain.unknown_m3) << position.transpose();
        total_m3 += gain.unknown_m3;
      }
    }
  }
  EXPECT_GT(total_m3, 1e4);
}

TEST(VolumetricGain, RowsMayLieAtAnotherAngleThanColumns) {
  OccupancyMap map{MapParams{}};
  const LocalWindow window(*map.freeze(), cube(12.0));
  SensorModel sensor = sensorOf(360, 30, 10);
  sensor.gain_row_angle_deg = 15.0;
  const auto gain = [&](GainCounting counting) {
    return GainEvaluator({sensor}, 0.2, counting)
        .evaluate(window, {0.1, 0.1, 0.1}, 0.0, AxisAlignedBox{});
  };
  const int per_ray = gain(GainCounting::kPerRay).unknown_voxels;
  EXPECT_GT(per_ray, 72 * 3 * 49) << "three rows, not seven";
  EXPECT_LT(per_ray, 72 * 3 * 87);
  const double half = 22.5 * M_PI / 180.0;  // a row sees half a row beyond it
  const double field = 2.0 * M_PI * 2.0 * std::sin(half) * 1000.0 / 3.0;
  EXPECT_NEAR(gain(GainCounting::kCone).unknown_m3, field, 0.02 * field);
}

TEST(VolumetricGain, ConesCountSoFarBeyondTheirFirstUnknownVoxel) {
  OccupancyMap map{MapParams{}};
  map.markFree({{-4.0, -4.0, -4.0}, {4.0, 4.0, 4.0}});
  const LocalWindow window(*map.freeze(), cube(12.0));
  SensorModel line = sensorOf(360, 1, 10);
  const auto gain = [&](double depth_m) {
    return GainEvaluator({line}, 0.2, GainCounting::kCone, depth_m)
        .evaluate(window, {0.1, 0.1, 0.1}, 0.0, AxisAlignedBox{});
  };
  const VolumetricGain all = gain(100.0);
  EXPECT_EQ(gain(std::numeric_limits<double>::infinity()).unknown_m3, all.unknown_m3);
  const VolumetricGain shallow = gain(1.0);
  EXPECT_LT(shallow.unknown_m3, 0.35 * all.unknown_m3);
  // Along an axis the free box ends 4 m away and 1 m more counts: five voxels a ray, more for
  // slanted ones.
  const auto rays = static_cast<int>(std::lround(360.0 / line.gain_resolution_deg)) *
                    (static_cast<int>(std::lround(1.0 / line.gain_resolution_deg)) + 1);
  EXPECT_GE(shallow.unknown_voxels, 5 * rays);
  EXPECT_LE(shallow.unknown_voxels, 9 * rays);
  EXPECT_EQ(shallow.free_voxels, all.free_voxels);
}

TEST(VolumetricGain, CameraSeesOnlyWhereItLooks) {
  OccupancyMap map{MapParams{}};
  map.markFree({{-9.0, -9.0, -3.0}, {0.0, 9.0, 3.0}});  // the half space behind is known
  const LocalWindow window(*map.freeze(), cube(8.0));
  const GainEvaluator camera({sensorOf(90, 30, 5)}, 0.2);
  const Eigen::Vector3d position(0.3, 0.1, 0.1);
  const int ahead = camera.evaluate(window, position, 0.0, AxisAlignedBox{}).unknown_voxels;
  const int behind = camera.evaluate(window, position, M_PI, AxisAlignedBox{}).unknown_voxels;
  EXPECT_GT(ahead, 1000);
  EXPECT_LT(behind, ahead / 20);
  SensorModel backwards = sensorOf(90, 30, 5);
  backwards.mount_yaw_deg = 180.0;
  const GainEvaluator rear({backwards}, 0.2);
  EXPECT_EQ(rear.evaluate(window, position, M_PI, AxisAlignedBox{}).unknown_voxels, ahead);
}

TEST(VolumetricGain, FullCircleDoesNotDependOnYaw) {
  const LocalWindow window(*hallMap(MapParams{}, 3, 900, 2).freeze(), cube(25.0));
  const GainEvaluator lidar({sensorOf(360, 30, 20)}, 0.2);
  const VolumetricGain at_zero = lidar.evaluate(window, {0.0, 0.0, 1.0}, 0.0, AxisAlignedBox{});
  expectEqual(lidar.evaluate(window, {0.0, 0.0, 1.0}, 2.1, AxisAlignedBox{}), at_zero);
}

TEST(VolumetricGain, PitchedSensorTurnsWithTheRobot) {
  OccupancyMap map{MapParams{}};
  map.markFree({{-9.0, -9.0, 0.0}, {9.0, 9.0, 6.0}});  // unknown only below
  const LocalWindow window(*map.freeze(), cube(10.0));
  SensorModel down = sensorOf(40, 30, 8);
  down.mount_pitch_deg = 45.0;
  SensorModel up = down;
  up.mount_pitch_deg = -45.0;
  const Eigen::Vector3d position(0.1, 0.1, 1.1);
  const GainEvaluator looks_down({down}, 0.2);
  const GainEvaluator looks_up({up}, 0.2);
  for (const double yaw : {0.0, 1.0, -2.0, 3.1}) {
    EXPECT_GT(looks_down.evaluate(window, position, yaw, AxisAlignedBox{}).unknown_voxels, 500);
    EXPECT_LT(looks_up.evaluate(window, position, yaw, AxisAlignedBox{}).unknown_voxels, 500);
  }
}

TEST(VolumetricGain, NothingCountsOutsideBoundsOrWindow) {
  OccupancyMap map{MapParams{}};
  const LocalWindow window(*map.freeze(), cube(5.0));
  const GainEvaluator lidar({sensorOf(360, 30, 20)}, 0.2);
  const AxisAlignedBox elsewhere{{1.0, 1.0, 1.0}, {2.0, 2.0, 2.0}};
  EXPECT_EQ(lidar.evaluate(window, {0, 0, 0}, 0.0, elsewhere).unknown_voxels, 0);
  EXPECT_EQ(lidar.evaluate(window, {50, 0, 0}, 0.0, AxisAlignedBox{}).unknown_voxels, 0);
  EXPECT_THROW(
      static_cast<void>(lidar.evaluate(window, {std::nan(""), 0, 0}, 0.0, AxisAlignedBox{})),
      Precondition);
}

TEST(VolumetricGain, ReachCoversMountAndRange) {
  SensorModel sensor = sensorOf(360, 30, 20);
  sensor.mount_m = {0.0, 3.0, 4.0};
  EXPECT_GE(GainEvaluator({sensor, sensorOf(90, 30, 8)}, 0.2).reach(), 25.0);
}

TEST(TemplateRays, FollowTheDirectionAndTheRange) {
  const TemplateRays rays(sensorOf(360, 30, 20), 0.2);
  ASSERT_EQ(rays.rays().size(), 504u);
  for (std::size_t i = 0; i < rays.rays().size(); ++i) {
    const double azimuth = static_cast<double>(i / 7) * 5.0 * M_PI / 180.0;
    const double elevation = (static_cast<double>(i % 7) * 5.0 - 15.0) * M_PI / 180.0;
    const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                    std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    VoxelIndex last = VoxelIndex::Zero();
    for (std::uint32_t k = rays.rays()[i].begin; k < rays.rays()[i].end; ++k) {
      const VoxelIndex at(rays.steps()[k][0], rays.steps()[k][1], rays.steps()[k][2]);
      ASSERT_EQ((at - last).cwiseAbs().sum(), 1) << "a ray must not skip voxels";
      const Eigen::Vector3d centre = at.cast<double>();
      const Eigen::Vector3d off_axis = centre - centre.dot(direction) * direction;
      ASSERT_LT(off_axis.norm(), 0.5 * std::sqrt(3.0) + 1e-6);
      last = at;
    }
    EXPECT_NEAR(last.cast<double>().norm(), 100.0, 1.0);
  }
}

}  // namespace
}  // namespace spelunk::map
