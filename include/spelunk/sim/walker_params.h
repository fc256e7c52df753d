#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "spelunk/common/params.h"

namespace spelunk::sim {

/// Body, legs and gait of a four-legged robot (section "walker"). The base is the centre of the
/// trunk; the legs carry no mass.
struct WalkerParams {
  std::string gait = "trot";  ///< "trot" or "walk"
  double gait_period_s = 0.6;
  double duty_factor = 0.6;
  double stand_height_m = 0.5;
  double swing_height_m = 0.1;
  double trunk_mass_kg = 30.0;
  Eigen::Vector3d trunk_m{0.9, 0.5, 0.3};
  Eigen::Vector3d hip_m{0.3, 0.14, 0.0};  ///< Left front hip; the others mirror it.
  double abduction_link_m = 0.1;
  double thigh_m = 0.3;
  double shank_m = 0.33;
  double abduction_max_deg = 45.0;
  double flexion_max_deg = 110.0;
  double knee_min_deg = 20.0;
  double knee_max_deg = 150.0;
  double foot_force_max_n = 450.0;
  double friction_coefficient = 0.7;
  double foothold_slope_max_deg = 38.0;
  double foothold_search_m = 0.2;
  double backward_share = 0.6;
  double sideways_share = 0.4;
  double standing_power_w = 180.0;
  double walking_power_w_per_mps = 250.0;

  /// Broken rules between fields, one text each with key and remedy; empty if all is well.
  [[nodiscard]] std::vector<std::string> problems() const;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("gait", gait, Bounds{}, "trot or walk", Audience::kUser);
    field("gait_period_s", gait_period_s, Bounds{0.2, 4.0}, "one step of every leg");
    field("duty_factor", duty_factor, Bounds{0.5, 0.95}, "share of the period on the ground");
    field("stand_height_m", stand_height_m, Bounds{0.1, 2.0}, "trunk centre above the feet");
    field("swing_height_m", swing_height_m, Bounds{0.02, 0.5}, "foot above what it steps over");
    field("trunk_mass_kg", trunk_mass_kg, Bounds{1.0, 500.0}, "mass of the robot");
    field("trunk_m", trunk_m, Bounds{0.05, 3.0}, "box that collides with the mesh");
    field("hip_m", hip_m, Bounds{-1.0, 2.0}, "left front hip in the base frame");
    field("abduction_link_m", abduction_link_m, Bounds{0.0, 0.5}, "hip axis to leg plane");
    field("thigh_m", thigh_m, Bounds{0.02, 2.0}, "hip to knee");
    field("shank_m", shank_m, Bounds{0.02, 2.0}, "knee to foot");
    field("abduction_max_deg", abduction_max_deg, Bounds{1.0, 90.0}, "to both sides");
    field("flexion_max_deg", flexion_max_deg, Bounds{5.0, 180.0}, "thigh, forward and back");
    field("knee_min_deg", knee_min_deg, Bounds{0.0, 170.0}, "knee bend, leg longest");
    field("knee_max_deg", knee_max_deg, Bounds{5.0, 175.0}, "knee bend, leg shortest");
    field("foot_force_max_n", foot_force_max_n, Bounds{10.0, 1e4}, "what a leg can push");
    field("friction_coefficient", friction_coefficient, Bounds{0.05, 2.0}, "foot on rock");
    field("foothold_slope_max_deg", foothold_slope_max_deg, Bounds{1.0, 80.0},
          "no foot is set on steeper ground");
    field("foothold_search_m", foothold_search_m, Bounds{0.0, 0.5}, "around the wanted foothold");
    field("backward_share", backward_share, Bounds{0.1, 1.0}, "of robot.speed_max_mps");
    field("sideways_share", sideways_share, Bounds{0.1, 1.0}, "of robot.speed_max_mps");
    field("standing_power_w", standing_power_w, Bounds{1.0, 1e4}, "electrical, standing");
    field("walking_power_w_per_mps", walking_power_w_per_mps, Bounds{0.0, 1e4},
          "more for each m/s");
  }
};

/// Principal moments of inertia of the trunk, a box of even density.
[[nodiscard]] Eigen::Vector3d trunkInertia(const WalkerParams& params);

}  // namespace spelunk::sim
