#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "spelunk/common/local_frame.h"
#include "spelunk/map/frozen_map.h"

namespace spelunk::evaluation {

/// The map from above, one cell a column of voxels, x fastest, south to north. Counts stop at 255.
struct PlanView {
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< South-west corner, world frame.
  double resolution_m = 0.2;
  int width = 0;                       ///< Columns along x.
  int height = 0;                      ///< Rows along y.
  double z_min_m = 0.0;                ///< Lower face of the lowest known layer.
  std::vector<std::uint8_t> free;      ///< Free voxels of a column.
  std::vector<std::uint8_t> occupied;  ///< Occupied voxels of a column.
  std::vector<std::uint8_t> floor;     ///< Layers from z_min_m to its lowest free voxel; 255: none.
};

/// An empty map gives a view of width and height 0.
[[nodiscard]] PlanView planViewOf(const map::FrozenMap& map);

/// Writes what scripts/plot_mission.py reads, in the caller's frame of `frame`, which is the map's:
/// one text line
/// "plan_view 1 <width> <height> <origin x> <origin y> <resolution> <z_min>", then the layers free,
/// occupied and floor as bytes. Throws OutsideError if the file cannot be written.
void writePlanView(const map::FrozenMap& map, const LocalFrame& frame, const std::string& path);

}  // namespace spelunk::evaluation
