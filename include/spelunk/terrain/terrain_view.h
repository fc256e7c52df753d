#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "spelunk/terrain/traversability.h"
#include "spelunk/terrain/window_grid.h"

namespace spelunk::terrain {

/// One cell for display.
struct TerrainPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< World; z of a drop: the lowest ray.
  double variance_m2 = 0.0;
  double value = 0.0;  ///< Traversability; 0 where the class is not kTraversable or unknown.
  GroundClass ground_class = GroundClass::kUnknown;
};

/// The terrain around the robot at one instant; immutable, shared between threads without locks.
/// A cell that is not covered (too far from the robot) is told apart from one that is unknown.
class TerrainView {
 public:
  TerrainView(const ElevationMap& elevation, const Traversability& traversability);

  [[nodiscard]] const WindowGrid& grid() const { return grid_; }
  /// Whether the cell lies in the part of the window that traversability is computed for.
  [[nodiscard]] bool covers(const CellIndex& cell) const;
  [[nodiscard]] bool covers(const Eigen::Vector2d& xy) const { return covers(grid_.cellOf(xy)); }

  /// kUnknown where not covered.
  [[nodiscard]] GroundClass classAt(const CellIndex& cell) const;
  /// Traversability; nothing where unknown or not covered.
  [[nodiscard]] std::optional<double> valueAt(const CellIndex& cell) const;
  /// Height of the ground at a place; nothing where never seen or not covered.
  [[nodiscard]] std::optional<double> groundHeight(const Eigen::Vector2d& xy) const;
  [[nodiscard]] std::optional<double> groundHeight(const CellIndex& cell) const;

  /// All covered cells that are known or a drop, row by row.
  [[nodiscard]] std::vector<TerrainPoint> points() const;
  /// Covered cells by class.
  [[nodiscard]] int count(GroundClass ground_class) const;

 private:
  template <class Visit>
  void forEachCovered(Visit&& visit) const;

  WindowGrid grid_;
  int margin_;
  std::vector<float> heights_;
  std::vector<float> variances_;
  std::vector<float> bounds_;
  std::vector<float> values_;
  std::vector<GroundClass> classes_;
};

}  // namespace spelunk::terrain
