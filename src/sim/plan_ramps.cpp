#include <algorithm>

#include "spelunk/sim/winding.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr int kLevels = 3;
constexpr double kLanding_m = 3.0;     ///< Level ground before and after each ramp.
constexpr double kRampOffset_m = 8.0;  ///< Ramps run so far beside the outer headings.

struct Layout {
  const RampsParams& params;
  WorldPlan& plan;
  Rng rng;

  [[nodiscard]] double floorOf(int level) const { return -level * params.level_drop_m; }

  void addDrift(const Vector3d& from, const Vector3d& to) {
    const Winding straight{
        0.0, params.width_min_m, params.width_max_m, params.height_m, params.height_m, 4.0};
    plan.passages.push_back(windingPassage(from, to, straight, rng));
  }

  void addLevel(int level) {
    const double z = floorOf(level);
    for (const double y : {0.0, params.heading_spacing_m})
      addDrift({0.0, y, z}, {params.level_length_m, y, z});
    const double pitch = params.crosscut_pitch_m;
    for (double x = 0.3 * pitch; x < params.level_length_m; x += pitch)
      addDrift({x, 0.0, z}, {x, params.heading_spacing_m, z});
  }

  /// A ramp down from `level`, beside the heading at `heading_y` on its outer `side` (-1 or 1).
  /// From the heading's place `x` it goes out, down towards +x, and back to the heading below.
  void addRamp(int level, double x, double heading_y, double side) {
    const double percent = rng.uniform(params.grade_min_percent, params.grade_max_percent);
    const double run = params.level_drop_m / (percent / 100.0);
    const double y = heading_y + side * kRampOffset_m;
    const double upper = floorOf(level);
    const double lower = floorOf(level + 1);
    const double width = 0.5 * (params.width_min_m + params.width_max_m);
    Passage ramp;
    ramp.root_m = 3.0;
    for (const Vector3d& floor :
         {Vector3d(x, heading_y, upper), Vector3d(x, y, upper), Vector3d(x + kLanding_m, y, upper),
          Vector3d(x + kLanding_m + 0.5 * run, y, 0.5 * (upper + lower)),
          Vector3d(x + kLanding_m + run, y, lower), Vector3d(x + 2.0 * kLanding_m + run, y, lower)})
      ramp.stations.push_back({floor, width, params.height_m});
    plan.passages.push_back(ramp);
    const double back_x = x + 2.0 * kLanding_m + run;
    addDrift({back_x, y, lower}, {std::min(back_x, params.level_length_m), heading_y, lower});
  }

  /// At the end of the uppermost heading the floor is missing down to the next level.
  void addShaft() {
    const double x = params.level_length_m;
    const double half = 0.5 * params.shaft_m;
    const double width = 0.5 * (params.width_min_m + params.width_max_m);
    const double centre_x = x + 0.5 * width + half - 0.6;  // overlaps the heading's round end
    plan.halls.push_back({{centre_x, 0.0, floorOf(1)},
                          {params.shaft_m, params.shaft_m},
                          params.level_drop_m + params.height_m});
    addDrift({x, 0.0, floorOf(1)}, {centre_x, 0.0, floorOf(1)});
  }
};

}  // namespace

void layOut(const RampsParams& params, WorldPlan& plan) {
  Layout layout{params, plan, Rng(plan.seed).fork("world/ramps")};
  for (int level = 0; level < kLevels; ++level) layout.addLevel(level);
  for (int level = 0; level + 1 < kLevels; ++level) {
    layout.addRamp(level, 0.15 * params.level_length_m, 0.0, -1.0);
    layout.addRamp(level, 0.25 * params.level_length_m, params.heading_spacing_m, 1.0);
  }
  layout.addShaft();
}

}  // namespace spelunk::sim
