#include <algorithm>
#include <array>

#include "spelunk/sim/winding.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {
namespace {

/// One half of the mine: crossings on a jittered grid.
struct Field {
  int columns = 0;
  int rows = 0;
  double pitch = 0.0;
  double left = 0.0;    ///< x of its first column.
  double bottom = 0.0;  ///< y of its first row.
  double width_min = 0.0;
  double width_max = 0.0;
  std::vector<Eigen::Vector2d> crossings;

  [[nodiscard]] const Eigen::Vector2d& at(int column, int row) const {
    return crossings[static_cast<std::size_t>(row * columns + column)];
  }
};

struct Layout {
  const RoomsParams& params;
  WorldPlan& plan;
  Rng rng;
  Relief relief;

  void addStreet(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_min,
                 double width_max) {
    const Winding winding{0.0, width_min, width_max, params.height_min_m, params.height_max_m, 6.0};
    Passage passage =
        windingPassage({from.x(), from.y(), 0.0}, {to.x(), to.y(), 0.0}, winding, rng);
    relief.lift(passage);
    plan.passages.push_back(passage);
  }

  void placeCrossings(Field& field) {
    const double jitter = std::min(1.2, 0.1 * field.pitch);
    for (int row = 0; row < field.rows; ++row)
      for (int column = 0; column < field.columns; ++column)
        field.crossings.emplace_back(
            field.left + column * field.pitch + rng.uniform(-jitter, jitter),
            field.bottom + row * field.pitch + rng.uniform(-jitter, jitter));
  }

  void addStreets(const Field& field) {
    Edges all;
    for (int row = 0; row < field.rows; ++row) {
      for (int column = 0; column < field.columns; ++column) {
        const int place = row * field.columns + column;
        if (column + 1 < field.columns) all.emplace_back(place, place + 1);
        if (row + 1 < field.rows) all.emplace_back(place, place + field.columns);
      }
    }
    // A spanning tree holds about half of a grid's edges, so the others make up for it.
    const double extra = std::max(0.0, 1.0 - 2.0 * params.closed_share);
    for (const auto& [a, b] : thinned(all, field.columns * field.rows, extra, rng))
      addStreet(field.crossings[static_cast<std::size_t>(a)],
                field.crossings[static_cast<std::size_t>(b)], field.width_min, field.width_max);
  }

  /// Openings through the barrier between the halves; the first is the uppermost and narrowest.
  void addOpenings(const Field& wide, const Field& narrow) {
    const std::array<int, 3> rows{wide.rows - 2, wide.rows / 2, 1};
    for (int k = 0; k < params.openings; ++k) {
      const int row = rows[static_cast<std::size_t>(k)];
      const Eigen::Vector2d& from = wide.at(wide.columns - 1, std::clamp(row, 0, wide.rows - 1));
      int best = 0;
      for (int i = 1; i < narrow.rows; ++i)
        if (std::abs(narrow.at(0, i).y() - from.y()) < std::abs(narrow.at(0, best).y() - from.y()))
          best = i;
      const bool narrowest = k == 0;
      addStreet(from, narrow.at(0, best), narrowest ? params.opening_m : narrow.width_min,
                narrowest ? params.opening_m : narrow.width_max);
    }
  }
};

}  // namespace

void layOut(const RoomsParams& params, WorldPlan& plan) {
  Layout layout{params, plan, Rng(plan.seed).fork("world/rooms"),
                Relief(params.relief_m, 60.0, plan.start.position.head<2>(), plan.seed + 17)};
  Field wide{params.wide_columns,
             params.wide_rows,
             params.wide_pitch_m,
             0.0,
             0.0,
             params.wide_min_m,
             params.wide_max_m,
             {}};
  const double barrier = 14.0;
  const double wide_height = (params.wide_rows - 1) * params.wide_pitch_m;
  const double narrow_height = (params.narrow_rows - 1) * params.narrow_pitch_m;
  Field narrow{params.narrow_columns,
               params.narrow_rows,
               params.narrow_pitch_m,
               (params.wide_columns - 1) * params.wide_pitch_m + barrier,
               (wide_height - narrow_height) / 2.0,
               params.narrow_min_m,
               params.narrow_max_m,
               {}};
  layout.placeCrossings(wide);
  layout.placeCrossings(narrow);
  layout.addStreets(wide);
  layout.addStreets(narrow);
  layout.addOpenings(wide, narrow);
}

}  // namespace spelunk::sim
