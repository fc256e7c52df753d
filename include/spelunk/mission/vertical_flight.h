#pragma once

#include <optional>

#include "spelunk/mission/basis.h"

namespace spelunk::mission {

/// Take-off and landing of a robot that flies: straight up from where it stands to where its whole
/// safety box is free, and straight down again. A robot that begins in free air needs neither, nor
/// does one with legs.
class VerticalFlight {
 public:
  explicit VerticalFlight(const Basis& basis) : basis_(basis) {}

  /// Whether the robot stands where something below it touches its safety box, with room above.
  [[nodiscard]] bool isNeeded() const;
  /// Notes that the robot stands here: it will land here.
  void begin() { stand_ = basis_.watch.pose(); }
  /// The next part of the climb, as high as is seen to be free, up to the take-off height of the
  /// robot's description above where it stood; none at its end.
  [[nodiscard]] std::optional<Leg> findClimb() const;
  /// Whether the robot took off from a place to land on.
  [[nodiscard]] bool hasStand() const { return stand_.has_value(); }
  /// The way down from above the place where it stood; none if something lies below.
  [[nodiscard]] std::optional<Leg> findLanding() const;
  [[nodiscard]] bool hasLanded() const;

 private:
  [[nodiscard]] bool isColumnFree(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;

  Basis basis_;
  std::optional<Pose> stand_;
};

}  // namespace spelunk::mission
