#pragma once

#include "spelunk/common/params.h"

namespace spelunk::mission {

/// Parameters of the mission (section "mission").
struct MissionParams {
  double reserve_s = 20.0;
  double reserve_percent = 3.0;
  double pessimism = 1.15;    ///< Travel times are taken this much longer.
  double plan_ahead_s = 1.5;  ///< A new path takes over this long after it was asked for.
  double deviation_max_m = 0.8;
  bool verify_ground = true;  ///< Legged robots only.
  double home_radius_m = 1.0;
  double replan_period_s = 2.0;    ///< Local paths are renewed this often while they are flown.
  double start_clearance_m = 1.0;  ///< Unknown space so near around the start counts as free.
  int max_samples = 10000;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("reserve_s", reserve_s, Bounds{0.0, 1e5}, "endurance that must be left at home",
          Audience::kUser);
    field("reserve_percent", reserve_percent, Bounds{0.0, 90.0}, "the same, of the full endurance",
          Audience::kUser);
    field("pessimism", pessimism, Bounds{1.0, 5.0}, "factor on every travel time home");
    field("plan_ahead_s", plan_ahead_s, Bounds{0.0, 30.0}, "the next path starts this far ahead");
    field("deviation_max_m", deviation_max_m, Bounds{0.05, 10.0},
          "farther from the path: hold and replan");
    field("verify_ground", verify_ground, Bounds{},
          "look at the ground ahead while walking (legged)");
    field("home_radius_m", home_radius_m, Bounds{0.1, 10.0}, "nearer counts as home");
    field("replan_period_s", replan_period_s, Bounds{0.2, 1000.0},
          "a local path is renewed so often");
    field("start_clearance_m", start_clearance_m, Bounds{0.0, 5.0},
          "unknown space around the start taken as free");
    field("max_samples", max_samples, Bounds{10, 10000000}, "samples tried by one plan");
  }
};

}  // namespace spelunk::mission
