#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "spelunk/sim/flight_controller.h"
#include "spelunk/sim/foothold_search.h"
#include "spelunk/sim/force_distribution.h"
#include "spelunk/sim/gait.h"
#include "spelunk/sim/leg_kinematics.h"
#include "spelunk/sim/motion_reference.h"
#include "spelunk/sim/swing_curve.h"
#include "spelunk/sim/trunk_posture.h"

namespace spelunk::sim {

/// kSearching: in the air without a place to stand.
enum class FootPhase { kStance, kSwing, kSearching };

struct Foot {
  FootPhase phase = FootPhase::kStance;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< World frame.
  Foothold hold;                                       ///< Where it stands or is about to.
  SwingCurve curve;
  Eigen::Vector3d aim = Eigen::Vector3d::Zero();  ///< Swinging: the place `hold` was found for.
  double next_look_s = 0.0;                       ///< Swinging: swung_s at which to look again.
  double swung_s = 0.0;
  double swing_s = 0.0;
  Eigen::Vector3d hang = Eigen::Vector3d::Zero();  ///< Searching: base frame.
  double slid_m = 0.0;                             ///< In this stance.
  bool has_stepped = false;                        ///< Since the gait last wanted it to swing.
};

/// The four legs: when each lifts, where it is set down, and whether it holds there.
class Stepping {
 public:
  /// All feet stand on `holds`. Keeps a reference to `scene`.
  Stepping(const WalkerParams& params, const MeshScene& scene,
           const std::array<Foothold, kLegs>& holds);

  /// Moves gait and feet on by `step_s`; the trunk goes at `command`.
  void advance(double step_s, const BodyState& trunk, const DriveCommand& command);

  /// Where the feet stand or are about to.
  [[nodiscard]] FootPoints grounds() const;

  /// The feet that stand, with levers from the trunk's centre.
  [[nodiscard]] std::vector<FootContact> contacts(const BodyState& trunk) const;

  /// What the standing feet can give of `forces` (one a contact, in order): no pull, no more than
  /// the leg's strength, no more along the ground than friction. A foot that lacks friction slides.
  [[nodiscard]] std::vector<Eigen::Vector3d> held(double step_s,
                                                  const std::vector<Eigen::Vector3d>& forces);

  [[nodiscard]] const std::array<Foot, kLegs>& feet() const { return feet_; }
  /// kWanting while a foot is searching.
  [[nodiscard]] Footing footing() const;
  [[nodiscard]] int slips() const { return slips_; }
  /// Swinging feet that ran into rock: they are drawn up and look for another place.
  [[nodiscard]] int trips() const { return trips_; }

 private:
  struct Motion;
  void stand(std::size_t leg, const Motion& motion, bool wants_to_step);
  void swing(std::size_t leg, const Motion& motion);
  void redirect(std::size_t leg, const Motion& motion);
  void search(std::size_t leg, const Motion& motion);
  void giveUp(std::size_t leg);
  [[nodiscard]] bool aimAt(std::size_t leg, const Motion& motion, double duration_s);
  [[nodiscard]] bool wantsToStep(const Motion& motion) const;
  [[nodiscard]] bool canLift(std::size_t leg) const;
  void slide(Foot& foot, const Eigen::Vector3d& excess_n, double step_s);

  std::array<Leg, kLegs> legs_;
  FootholdSearch ground_;
  Gait gait_;
  double swing_height_;
  double friction_;
  double force_max_;
  bool is_walk_;
  std::array<Foot, kLegs> feet_;
  Eigen::Isometry3d T_base_world_ = Eigen::Isometry3d::Identity();
  bool was_stepping_ = false;
  int slips_ = 0;
  int trips_ = 0;
};

}  // namespace spelunk::sim
