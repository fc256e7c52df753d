#pragma once

#include <Eigen/Core>
#include <vector>

#include "scan_cells.h"
#include "spelunk/terrain/window_grid.h"

namespace spelunk::terrain {

/// Lowers the bounds under one ray that goes down from `sensor` to `end` (both in the window, see
/// WindowFrame): a surface below the ray is lower than the ray. One cell a step along the longer
/// axis, walked from the end backwards to the sensor; the end's own cell is left out. Bounds fall
/// by more than a millimetre or not at all; the cells where they fell are appended to `changed`.
void lowerBoundsAlong(const Eigen::Vector3f& sensor, const Eigen::Vector3f& end,
                      const WindowGrid& grid, std::vector<float>& bounds,
                      std::vector<CellIndex>& changed);

/// Where the lowest ray of a sector leaves the window.
[[nodiscard]] Eigen::Vector3f exitOf(const ScanCells::Sector& sector, const Eigen::Vector3f& sensor,
                                     float extent_m);

}  // namespace spelunk::terrain
