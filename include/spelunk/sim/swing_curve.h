#pragma once

#include <Eigen/Core>

#include "spelunk/sim/foothold_search.h"

namespace spelunk::sim {

/// The way of a foot through the air: it rises, crosses and comes down, with no speed at both ends.
class SwingCurve {
 public:
  SwingCurve() = default;

  /// From `from` to `to`, clearing the ground between them by `clearance_m` at the top. Ground is
  /// looked for below `ceiling_z`.
  SwingCurve(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double clearance_m,
             double ceiling_z, const FootholdSearch& ground);

  /// From `share` of the time on, the foot goes to another place without a jump; `share` must lie
  /// before the foot comes down. Ground between is cleared by the same height.
  void redirect(double share, const Eigen::Vector3d& to, double ceiling_z,
                const FootholdSearch& ground);

  /// The foot after a share (0 .. 1) of the swing's time.
  [[nodiscard]] Eigen::Vector3d at(double share) const;

  /// Whether the foot goes sideways then; before and after it only rises or sinks.
  [[nodiscard]] static bool crosses(double share);

  [[nodiscard]] const Eigen::Vector3d& end() const { return to_; }
  [[nodiscard]] double top() const { return top_z_ + rise_m_; }  ///< Its greatest height.

 private:
  [[nodiscard]] double topAt(double share) const;

  Eigen::Vector3d from_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_ = Eigen::Vector3d::Zero();
  double clearance_m_ = 0.0;
  double top_z_ = 0.0;
  double rise_m_ = 0.0;  ///< Of the top, from `rise_from_` on.
  double rise_from_ = 0.0;
};

}  // namespace spelunk::sim
