#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "spelunk/sim/walker_params.h"

namespace spelunk::sim {

inline constexpr std::size_t kLegs = 4;
/// Left front, right front, left hind, right hind: the order of everything that has one a leg.
inline constexpr std::array<const char*, kLegs> kLegNames{"LF", "RF", "LH", "RH"};

/// Joint angles of one leg, radians: abduction about base x, then flexion of the hip and bend of
/// the knee about the leg's y.
struct LegAngles {
  double abduction = 0.0;
  double flexion = 0.0;  ///< Positive swings the leg backward.
  double knee = 0.0;
};

/// One leg: where it is fixed, how long it is, what its joints allow.
class Leg {
 public:
  Leg(const WalkerParams& params, std::size_t index);

  /// Foot in the base frame.
  [[nodiscard]] Eigen::Vector3d footAt(const LegAngles& angles) const;

  /// The angles that put the foot at `foot` (base frame) with the knee bent to its side; nothing if
  /// the leg does not reach there or a joint's limit is in the way.
  [[nodiscard]] std::optional<LegAngles> anglesFor(const Eigen::Vector3d& foot) const;

  [[nodiscard]] const Eigen::Vector3d& hip() const { return hip_; }

  /// Below it the leg hangs straight down: hip and abduction link, base frame.
  [[nodiscard]] Eigen::Vector3d root() const;

  [[nodiscard]] double longest() const { return longest_; }    ///< Root to foot, metres.
  [[nodiscard]] double shortest() const { return shortest_; }  ///< Root to foot, metres.

 private:
  Eigen::Vector3d hip_;
  double link_;  ///< Signed: to the left is positive.
  double thigh_;
  double shank_;
  double knee_side_;  ///< Front knees point backward (-1), hind knees forward (1).
  double abduction_max_;
  double flexion_max_;
  double knee_min_;
  double knee_max_;
  double longest_;
  double shortest_;
};

[[nodiscard]] std::array<Leg, kLegs> legsOf(const WalkerParams& params);

}  // namespace spelunk::sim
