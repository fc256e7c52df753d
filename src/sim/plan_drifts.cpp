#include <algorithm>
#include <cmath>

#include "spelunk/sim/winding.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {
namespace {

/// The steps of laying out one mine.
struct Layout {
  const DriftsParams& params;
  WorldPlan& plan;
  Rng rng;
  Relief relief;

  [[nodiscard]] Winding usual() const {
    return {params.wander_m,     params.width_min_m,  params.width_max_m,
            params.height_min_m, params.height_max_m, 4.0};
  }

  void addDrift(double from_x, double from_y, double to_x, double to_y, const Winding& winding) {
    Passage passage = windingPassage({from_x, from_y, 0.0}, {to_x, to_y, 0.0}, winding, rng);
    relief.lift(passage);
    plan.passages.push_back(passage);
  }

  /// Headings keep to their line, so that crosscuts and gate roads meet them, and are wide.
  void addHeadings() {
    Winding winding = usual();
    winding.wander_m = std::min(0.4, params.wander_m);
    winding.width_min_m = (params.width_min_m + params.width_max_m) / 2.0;
    addDrift(0.0, 0.0, params.heading_length_m, 0.0, winding);
    const double y = params.heading_spacing_m;
    addDrift(6.0, y, params.heading_length_m - 8.0, y, winding);
  }

  void addCrosscuts() {
    Winding winding = usual();
    winding.wander_m = std::min(1.0, params.wander_m);
    for (double x = params.crosscut_pitch_m / 2.0; x < params.heading_length_m - 10.0;
         x += params.crosscut_pitch_m)
      addDrift(x, 0.0, x + rng.uniform(-2.0, 2.0), params.heading_spacing_m, winding);
  }

  /// Gate roads leave a heading at y = `base` towards `side` (-1 or 1).
  void addGates(double base, double side) {
    const double pitch = params.gate_pitch_m;
    const double inset = side > 0.0 ? 0.45 : 0.2;
    double before_x = 0.0;
    double before_reach = -1.0;
    for (double x = inset * pitch; x < params.heading_length_m - 9.0; x += pitch) {
      const double reach = rng.uniform(params.gate_length_min_m, params.gate_length_max_m);
      addDrift(x, base, x, base + side * reach, usual());
      if (before_reach > 0.0) joinGates(before_x, before_reach, x, reach, base, side);
      addStub(x, base, side, reach);
      before_x = x;
      before_reach = reach;
    }
  }

  void joinGates(double from_x, double from_reach, double to_x, double to_reach, double base,
                 double side) {
    if (rng.uniform() >= params.face_probability) return;
    const double common = std::min(from_reach, to_reach);
    const bool at_the_end = rng.uniform() < 0.5;
    const double from_y = at_the_end ? from_reach : 0.55 * common;
    const double to_y = at_the_end ? to_reach : 0.6 * common;
    Winding winding = usual();
    winding.station_pitch_m = 3.0;
    const auto onGate = [&](double x, double reach) { return gateAt(x, base + side * reach); };
    const Eigen::Vector2d from = onGate(from_x, from_y);
    const Eigen::Vector2d to = onGate(to_x, to_y);
    addDrift(from.x(), from.y(), to.x(), to.y(), winding);
  }

  /// The point at height `y` of the newest gate road that was driven along `x`.
  [[nodiscard]] Eigen::Vector2d gateAt(double x, double y) const {
    Eigen::Vector2d best(x, y);
    double least = 1e9;
    for (const Passage& passage : plan.passages) {
      const Eigen::Vector3d& first = passage.stations.front().floor;
      const Eigen::Vector3d& last = passage.stations.back().floor;
      if (first.x() != x || last.x() != x) continue;
      for (const Station& station : passage.stations) {
        const double gap = std::abs(station.floor.y() - y);
        if (gap >= least) continue;
        least = gap;
        best = station.floor.head<2>();
      }
    }
    return best;
  }

  void addStub(double x, double base, double side, double reach) {
    if (rng.uniform() >= params.stub_probability) return;
    const Eigen::Vector2d from = gateAt(x, base + side * reach * rng.uniform(0.25, 0.8));
    const double direction = rng.uniform() < 0.5 ? -1.0 : 1.0;
    const double length = params.stub_length_m * rng.uniform(0.6, 1.2);
    Winding winding = usual();
    winding.wander_m = std::min(0.8, params.wander_m);
    addDrift(from.x(), from.y(), from.x() + direction * length,
             from.y() + side * rng.uniform(0.0, 0.4) * length, winding);
  }
};

}  // namespace

void layOut(const DriftsParams& params, WorldPlan& plan) {
  Layout layout{params, plan, Rng(plan.seed).fork("world/drifts"),
                Relief(params.relief_m, 55.0, plan.start.position.head<2>(), plan.seed + 17)};
  layout.addHeadings();
  layout.addCrosscuts();
  layout.addGates(0.0, -1.0);
  layout.addGates(params.heading_spacing_m, 1.0);
}

}  // namespace spelunk::sim
