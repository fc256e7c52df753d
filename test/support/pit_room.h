#pragma once

#include "support/meshes.h"

namespace spelunk::test {

/// A room of 20 x 7 x 3 m from x = -4 on, its floor at z = 0, with a pit (0.8 m deep, 1.2 m long,
/// 2.6 m wide) and behind it a block 0.4 m high, both across the straight way along y = 0; a robot
/// with legs can pass beside each. What lies behind the wall at x = 12 can only be seen from its
/// door (2.2 m wide, at the side), which makes the robot walk.
inline sim::WorldMesh pitRoom() {
  sim::WorldMesh mesh;
  mesh.name = "pit_room";
  const auto solid = [&](float x0, float y0, float z0, float x1, float y1, float z1) {
    addBox(mesh, {x0, y0, z0}, {x1, y1, z1});
  };
  solid(-4, -3.5F, -1.0F, 16, 3.5F, -0.8F);  // under the pit
  solid(-4, -3.5F, -0.8F, 4, 3.5F, 0);       // the floor around it
  solid(5.2F, -3.5F, -0.8F, 16, 3.5F, 0);
  solid(4, -3.5F, -0.8F, 5.2F, -1.3F, 0);
  solid(4, 1.3F, -0.8F, 5.2F, 3.5F, 0);
  solid(9, -1.4F, 0, 9.8F, 1.4F, 0.4F);  // the block
  solid(12, -1.3F, 0, 12.2F, 3.5F, 3);
  solid(-4.2F, -3.7F, -1, -4, 3.7F, 3.2F);
  solid(16, -3.7F, -1, 16.2F, 3.7F, 3.2F);
  solid(-4, -3.7F, -1, 16, -3.5F, 3.2F);
  solid(-4, 3.5F, -1, 16, 3.7F, 3.2F);
  solid(-4, -3.5F, 3, 16, 3.5F, 3.2F);
  return mesh;
}

}  // namespace spelunk::test
