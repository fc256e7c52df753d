#pragma once

#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/PointCloud2.h>

#include <string>

#include "spelunk/terrain/terrain_view.h"

namespace spelunk::bridge {

/// The covered cells of a view as a grid in `frame`: -1 unknown, 100 untraversable or a drop, else
/// 0 (best) to 98 (worst). The grid is drawn at the median height of the known ground.
[[nodiscard]] nav_msgs::OccupancyGrid traversabilityMsg(const terrain::TerrainView& view,
                                                        const std::string& frame,
                                                        const ::ros::Time& stamp);

/// The known cells and drops of a view as points in `frame`: float32 x, y, z, rgb packed into a
/// float32 as viewers expect (colours of terrainColour), traversability (0 .. 1; NaN where
/// unknown) and variance_m2.
[[nodiscard]] sensor_msgs::PointCloud2 elevationMsg(const terrain::TerrainView& view,
                                                    const std::string& frame,
                                                    const ::ros::Time& stamp);

}  // namespace spelunk::bridge
