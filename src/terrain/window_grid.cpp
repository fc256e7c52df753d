#include "spelunk/terrain/window_grid.h"

#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::terrain {

WindowGrid::WindowGrid(double cell_m, double reach_m) : cell_m_(cell_m) {
  require(std::isfinite(cell_m) && cell_m > 0.0, "WindowGrid: cell size must be positive");
  require(std::isfinite(reach_m) && reach_m >= cell_m, "WindowGrid: reach must exceed a cell");
  require(reach_m / cell_m < 2047.0, "WindowGrid: more than 4096 cells a side");
  side_ = 2 * static_cast<int>(std::ceil(reach_m / cell_m - 1e-9)) + 1;
  stride_ = 1;
  while (stride_ < side_) stride_ *= 2;
  mask_ = stride_ - 1;
  moveTo(CellIndex::Zero());
}

CellIndex WindowGrid::cellOf(const Eigen::Vector2d& xy) const {
  return (xy / cell_m_).array().floor().cast<int>();
}

}  // namespace spelunk::terrain
