#include <gtest/gtest.h>

#include <iostream>

#include "terrain_worlds.h"

namespace spelunk::terrain {
namespace {

TEST(Drop, Probe) {
  for (auto sight : {Sight::kLidarOnly, Sight::kLidarAndCamera})
    for (double to : {0.0, 0.5, 1.0, 1.5}) {
      const sim::WorldMesh mesh = groundWithHole(2.5, 0.5, 1.0);
      const sim::MeshScene scene(mesh);
      TerrainMap terrain{TerrainParams{}};
      terrain.assumeGroundUnder(baseAt(-0.5,0));
      walk(terrain, scene, -0.5, to, sight);
      std::cout << "sight " << static_cast<int>(sight) << " x=" << to << "\n"
                << pictureOf(*terrain.freeze(), -1, 4.4, -1.0, 1.0, 0.08) << std::endl;
      const auto check = terrain.checkPath({{{to, 0, 0.5}, 0}, {{to + 3.0, 0, 0.5}, 0}});
      std::cout << int(check.status) << " arc " << check.arc_m << " reason " << letterOf(check.reason) << " where "
                << check.where.transpose() << " r " << check.radius_m << " unk " << check.unknown_share << std::endl;
    }
}

}  // namespace
}  // namespace spelunk::terrain
