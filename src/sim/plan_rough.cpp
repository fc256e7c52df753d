#include <cmath>

#include "spelunk/sim/winding.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr double kAnchor_m = 0.3;  ///< Blocks reach so far into the floor.

struct Layout {
  const RoughParams& params;
  WorldPlan& plan;
  Rng rng;

  void addDrift(const Vector3d& from, const Vector3d& to) {
    const Winding straight{0.0, params.width_m, params.width_m, params.height_m, params.height_m,
                           4.0};
    plan.passages.push_back(windingPassage(from, to, straight, rng));
  }

  /// A block of `height` on the floor around (x, y).
  void addBlock(double x, double y, double length, double width, double height) {
    plan.blocks.push_back(
        {{x, y, 0.5 * (height - kAnchor_m)}, {length, width, height + kAnchor_m}});
  }

  void addRubble(double x, double y) {
    for (int k = 0; k < 14; ++k) {
      const double along = rng.uniform(-1.5, 1.5);
      const double across = rng.uniform(-0.4, 0.4) * params.width_m;
      const double length = rng.uniform(0.25, 0.6);
      const double width = rng.uniform(0.25, 0.6);
      addBlock(x + along, y + across, length, width, rng.uniform(0.05, params.rubble_max_m));
    }
  }

  void addRails(double x, double y) {
    constexpr double kGauge_m = 0.9;
    for (const double side : {-0.5, 0.5})
      addBlock(x, y + side * kGauge_m, 0.9 * params.obstacle_pitch_m, 0.15, 0.12);
  }

  /// A low step crosses the drift, a high one leaves more than half of it.
  void addStep(double x, double y, double side) {
    const double height = rng.uniform(params.step_min_m, params.step_max_m);
    if (height <= params.easy_step_m) {
      addBlock(x, y, 1.6, params.width_m + 1.0, height);
    } else {
      const double width = 0.45 * params.width_m + 0.5;
      addBlock(x, y + side * 0.5 * (params.width_m + 1.0 - width), 1.2, width, height);
    }
  }

  /// A hole on one side of the drift.
  void addHole(double x, double y, double side) {
    const double size = rng.uniform(params.hole_min_m, params.hole_max_m);
    const double off = 0.5 * params.width_m - 0.5 * size - 0.4;
    plan.pits.push_back({{x, y + side * off, 0.0}, {size, size}, params.hole_depth_m});
  }

  /// One obstacle each pitch, clear of the crossings: the kinds take turns.
  void addObstacles(double y, int first_kind) {
    int kind = first_kind;
    for (double x = 8.0; x < params.length_m - 5.0; x += params.obstacle_pitch_m) {
      if (std::abs(x - 0.5 * params.length_m) < params.width_m) continue;
      const double side = rng.uniform() < 0.5 ? -1.0 : 1.0;
      switch (kind++ % 4) {
        case 0:
          addRails(x, y);
          break;
        case 1:
          addHole(x, y, side);
          break;
        case 2:
          addRubble(x, y);
          break;
        default:
          addStep(x, y, side);
      }
    }
  }
};

}  // namespace

void layOut(const RoughParams& params, WorldPlan& plan) {
  Layout layout{params, plan, Rng(plan.seed).fork("world/rough")};
  const double length = params.length_m;
  for (const double y : {0.0, params.spacing_m}) layout.addDrift({0, y, 0}, {length, y, 0});
  for (const double x : {2.5, 0.5 * length, length - 2.5})
    layout.addDrift({x, 0, 0}, {x, params.spacing_m, 0});
  layout.addObstacles(0.0, 0);
  layout.addObstacles(params.spacing_m, 2);
  layout.addBlock(0.5 * length, 0.5 * params.spacing_m, params.width_m + 1.0, 1.5,
                  params.step_max_m);
}

}  // namespace spelunk::sim
