#include "spelunk/sim/swing_curve.h"

#include <algorithm>

namespace spelunk::sim {
namespace {

constexpr double kRise = 0.35;   ///< Share of the time at which the foot is at the top ...
constexpr double kSink = 0.65;   ///< ... and from which it comes down.
constexpr double kLeave = 0.15;  ///< The foot crosses between this and kArrive.
constexpr double kArrive = 0.85;
constexpr int kProbes = 5;  ///< Looks at the ground on the way.

/// 0 up to `first`, 1 from `last`, smooth in between.
double smoothStep(double value, double first, double last) {
  const double t = std::clamp((value - first) / (last - first), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

SwingCurve::SwingCurve(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double clearance_m,
                       double ceiling_z, const FootholdSearch& ground)
    : from_(from), to_(to) {
  const double low = std::min(from.z(), to.z());
  double highest = std::max(from.z(), to.z());
  for (int k = 1; k <= kProbes; ++k) {
    Eigen::Vector3d above = from + static_cast<double>(k) / (kProbes + 1) * (to - from);
    above.z() = ceiling_z;
    if (const auto hit = ground.groundBelow(above, std::max(0.0, ceiling_z - low)))
      highest = std::max(highest, hit->position.z());
  }
  top_z_ = highest + clearance_m;
}

Eigen::Vector3d SwingCurve::at(double share) const {
  const double across = smoothStep(share, kLeave, kArrive);
  Eigen::Vector3d foot = from_ + across * (to_ - from_);
  foot.z() = share < kSink ? from_.z() + smoothStep(share, 0.0, kRise) * (top_z_ - from_.z())
                           : top_z_ + smoothStep(share, kSink, 1.0) * (to_.z() - top_z_);
  return foot;
}

bool SwingCurve::crosses(double share) { return share > kLeave && share < kArrive; }

}  // namespace spelunk::sim
