#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "spelunk/common/pose.h"

namespace spelunk::sim {

/// One cross-section of a passage: the middle of its floor and the free width and height there.
struct Station {
  Eigen::Vector3d floor = Eigen::Vector3d::Zero();
  double width = 3.0;
  double height = 3.0;
};

/// A gallery along a polyline of at least two stations, linear in between, round at its ends.
struct Passage {
  std::vector<Station> stations;
  /// How far below its floor a passage is still itself where stations meet. The default notches a
  /// sloping floor at its stations; half a width and more keeps it even.
  double root_m = 0.8;
};

/// A dome over an elliptic floor.
struct Chamber {
  Eigen::Vector3d floor = Eigen::Vector3d::Zero();
  Eigen::Vector2d radii{5.0, 5.0};
  double height = 4.0;
};

/// A room with upright walls, parallel to the axes.
struct Hall {
  Eigen::Vector3d floor = Eigen::Vector3d::Zero();  ///< Centre of the floor.
  Eigen::Vector2d size{10.0, 10.0};
  double height = 4.0;
};

/// Rock left standing from floor to roof, parallel to the axes.
struct Pillar {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d size{1.0, 1.0};
};

/// A box of rock parallel to the axes: a step, a rail, a lump of rubble.
struct Block {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
};

/// A hole in the floor with upright walls, parallel to the axes.
struct Pit {
  Eigen::Vector3d top = Eigen::Vector3d::Zero();  ///< Its middle, at the height of the floor.
  Eigen::Vector2d size{1.0, 1.0};
  double depth = 1.0;
};

/// A world before it becomes a mesh: the space that is free for certain. Metres, world frame, z up.
/// Roughness only carves further into the rock, so widths and heights are guaranteed minima up to
/// about a tenth of `cell_m`.
struct WorldPlan {
  std::string name;
  std::vector<Passage> passages;
  std::vector<Chamber> chambers;
  std::vector<Hall> halls;
  std::vector<Pillar> pillars;
  std::vector<Block> blocks;
  std::vector<Pit> pits;
  Pose start;
  double roughness_m = 0.3;  ///< Greatest depth of the roughness of walls; floors have a quarter.
  double grain_m = 3.5;      ///< Size of the bulges of that roughness.
  double blend_m = 0.8;      ///< Over this distance neighbouring spaces run into each other.
  double cell_m = 0.5;       ///< Grid of the surface.
  std::uint64_t seed = 1;
};

/// Reads a description (worlds/<name>.yaml) and lays the world out. Every number has a unit in its
/// name and a range. Throws OutsideError with all problems and the list of known names.
[[nodiscard]] WorldPlan planWorld(const std::string& description_path);

/// Length of all passages, metres.
[[nodiscard]] double passageLength(const WorldPlan& plan);

}  // namespace spelunk::sim
