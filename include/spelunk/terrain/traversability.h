#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/terrain/elevation_map.h"
#include "spelunk/terrain/window_grid.h"

namespace spelunk::terrain {

/// Parameters of the traversability of cells (section "terrain").
struct TraversabilityParams {
  double slope_limit_deg = 30.0;
  double step_limit_m = 0.25;
  double roughness_limit_m = 0.08;
  double slope_weight = 0.4;
  double step_weight = 0.3;
  double roughness_weight = 0.3;
  double value_min = 0.05;
  double slope_window_m = 0.3;
  double step_window_m = 0.08;
  double drop_margin_m = 0.06;
  double drop_slope_deg = 23.0;
  double drop_window_m = 0.5;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("slope_limit_deg", slope_limit_deg, Bounds{1.0, 80.0}, "steeper is not traversable",
          Audience::kUser);
    field("step_limit_m", step_limit_m, Bounds{0.01, 2.0}, "higher steps are not traversable",
          Audience::kUser);
    field("roughness_limit_m", roughness_limit_m, Bounds{0.005, 1.0},
          "rougher (deviation from the plane) is not traversable", Audience::kUser);
    field("slope_weight", slope_weight, Bounds{0.0, 1.0}, "share of the slope in the value");
    field("step_weight", step_weight, Bounds{0.0, 1.0}, "share of the step");
    field("roughness_weight", roughness_weight, Bounds{0.0, 1.0}, "share of the roughness");
    field("value_min", value_min, Bounds{0.0, 1.0}, "cells of less value are not traversable");
    field("slope_window_m", slope_window_m, Bounds{0.02, 2.0},
          "each way, of the plane for slope and roughness: half a body");
    field("step_window_m", step_window_m, Bounds{0.01, 1.0}, "each way, for steps: a foot");
    field("drop_margin_m", drop_margin_m, Bounds{0.01, 1.0},
          "unseen ground so much below all ground seen around it is a drop");
    field("drop_slope_deg", drop_slope_deg, Bounds{1.0, 60.0},
          "unseen ground may fall so steeply from the ground seen around it");
    field("drop_window_m", drop_window_m, Bounds{0.05, 2.0}, "each way, what counts as around it");
  }
  [[nodiscard]] std::vector<std::string> problems() const;
};

enum class GroundClass : std::uint8_t {
  kUnknown,  ///< Never seen, or too little around it to tell.
  kTraversable,
  kTooSteep,  ///< Which limit is exceeded by the largest factor.
  kStep,
  kTooRough,
  kDrop  ///< Not seen, but rays passed so low over it that no ground to walk on is there.
};

[[nodiscard]] const char* toText(GroundClass ground);  ///< "not seen", "too steep", ...

/// What the ground around one cell is like.
struct GroundShape {
  double slope_rad = 0.0;
  double step_m = 0.0;
  double roughness_m = 0.0;
};

/// Layers by slot of a WindowGrid. Plain values: copy to freeze.
struct TraversabilityLayers {
  std::vector<float> slope;  ///< Tangent.
  std::vector<float> step_m;
  std::vector<float> roughness_m;
  std::vector<float> value;  ///< 1 best, 0 not traversable; NaN where unknown.
  std::vector<GroundClass> ground_class;
};

struct CellRect;

/// Slope, step and roughness of every cell, each with a limit and a weight, and one value of them
/// (Dang 2020, section 4.3, after Wermelinger et al., Navigation planning for legged robots in
/// challenging terrain, IROS 2016).
///
/// Slope and roughness: the plane fitted to the known cells of a square window by least squares,
/// its tangent, and the root of the mean squared residual. Step: highest less lowest known cell of
/// a smaller window. value = 1 - sum of weight * (quantity / limit), 0 beyond a limit.
///
/// A cell nobody has seen is a drop when a ray (ElevationMap::rayBound) passed over it
///   - lower than the ground may fall by more than `drop_margin_m`, and lower by as much than all
///     ground seen around it (of which narrow gaps do not count: a hole's far wall is no ground),
///     or
///   - lower than the ground may fall by more than `step_limit_m`,
/// where the ground may fall from each known cell around it (lowered to the lowest within a foot's
/// window of that, lest the top of a wall count) by a parabola that, with the margin, is nowhere
/// less than drop_slope_deg. Otherwise it is unknown.
///
/// The outermost margin() cells of the window serve as neighbours only and stay unknown.
class Traversability {
 public:
  /// Throws Precondition if nothing remains between the margins.
  Traversability(const TraversabilityParams& params, const WindowGrid& grid);

  /// Cells from the window's edge that stay unknown, for a cell size.
  [[nodiscard]] static int marginOf(const TraversabilityParams& params, double cell_m);
  [[nodiscard]] int margin() const { return margin_; }

  /// Notes what changed in the map. Call after every call that changed it.
  void note(const ElevationMap& elevation);
  /// Recomputes what has been noted since the last update, and what the motion of the window
  /// brought in.
  void update(const ElevationMap& elevation);
  /// Recomputes everything: the same values bit by bit.
  void updateAll(const ElevationMap& elevation);

  [[nodiscard]] const TraversabilityLayers& layers() const { return layers_; }
  [[nodiscard]] const TraversabilityParams& params() const { return params_; }

 private:
  struct WindowSums;
  using Marks = std::vector<std::uint8_t>;
  void unwrap(const ElevationMap& elevation);
  void markEntered(const CellIndex& shift, Marks& marks) const;
  void markAround(const CellIndex& first, int reach, Marks& marks) const;
  [[nodiscard]] std::vector<CellRect> rectsOf(const Marks& marks) const;
  void computeShapes(const CellRect& rect, const WindowGrid& grid);
  void fitPlanes(const CellRect& rect);
  void sumRow(std::size_t cell);
  void solve(std::size_t cell);
  void addPlaces(std::size_t cell, WindowSums& sums) const;
  void rate(const CellRect& rect, const WindowGrid& grid);
  void forgetUnknown(const CellRect& rect, const WindowGrid& grid);
  void findDrops(const CellRect& rect, const WindowGrid& grid);
  void judgeUnknown(const CellRect& rect, const WindowGrid& grid);

  TraversabilityParams params_;
  float cell_m_;
  int side_;
  int plane_cells_;
  int step_cells_;
  int drop_cells_;
  int margin_;
  TraversabilityLayers layers_;
  CellIndex last_first_ = CellIndex::Zero();
  bool is_fresh_ = true;  ///< All is to be computed.
  float reference_z_ = 0.0F;
  std::vector<CellIndex> noted_;  ///< Cells that changed since the last update.
  bool noted_everywhere_ = false;

  // Working memory, by y * side + x; heights from reference_z_.
  std::vector<float> known_;   ///< 1 or 0.
  std::vector<float> height_;  ///< 0 where unknown.
  std::vector<float> low_;     ///< Very high where unknown.
  std::vector<float> high_;    ///< Very low where unknown.
  std::vector<float> bound_;
  std::array<std::vector<float>, 6> row_sums_;
  std::vector<float> slope_;  ///< Negative where no plane could be fitted.
  std::vector<float> roughness_;
  std::vector<float> lowest_;   ///< Within a foot's window.
  std::vector<float> highest_;  ///< The same.
  std::vector<float> upper_;    ///< lowest_ of known cells, very low elsewhere.
  std::vector<float> lower_;    ///< highest_ of known cells, very high elsewhere.
  std::vector<float> fall_;     ///< How low ground may be by the ground around it.
  std::vector<float> floor_;    ///< The lowest ground around.
  std::vector<float> scratch_;
};

}  // namespace spelunk::terrain
