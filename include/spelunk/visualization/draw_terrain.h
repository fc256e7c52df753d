#pragma once

#include <Eigen/Core>
#include <vector>

#include "spelunk/terrain/terrain_view.h"
#include "spelunk/visualization/scene.h"

namespace spelunk::visualization {

/// Green for the best ground over yellow for the worst that can be walked on; red for ground too
/// steep, too high a step or too rough; black for a drop; grey where ground was seen, but too
/// little around it to tell.
[[nodiscard]] Colour terrainColour(const terrain::TerrainPoint& point);

/// Every known cell and drop as a cube as large as the cell (layer "terrain").
void drawTerrain(const terrain::TerrainView& view, Scene& scene);

/// One foot of a walking robot.
struct FootMark {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< World.
  bool is_standing = false;
};

/// Feet that stand are white, feet in the air blue (layer "feet").
void drawFeet(const std::vector<FootMark>& feet, Scene& scene);

}  // namespace spelunk::visualization
