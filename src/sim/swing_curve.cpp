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

/// The highest ground between two places, below the ceiling.
double highestBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double ceiling_z,
                      const FootholdSearch& ground) {
  const double low = std::min(from.z(), to.z());
  double highest = std::max(from.z(), to.z());
  for (int k = 1; k <= kProbes; ++k) {
    Eigen::Vector3d above = from + static_cast<double>(k) / (kProbes + 1) * (to - from);
    above.z() = ceiling_z;
    if (const auto hit = ground.groundBelow(above, std::max(0.0, ceiling_z - low)))
      highest = std::max(highest, hit->position.z());
  }
  return highest;
}

}  // namespace

SwingCurve::SwingCurve(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double clearance_m,
                       double ceiling_z, const FootholdSearch& ground)
    : from_(from),
      to_(to),
      clearance_m_(clearance_m),
      top_z_(highestBetween(from, to, ceiling_z, ground) + clearance_m) {}

void SwingCurve::redirect(double share, const Eigen::Vector3d& to, double ceiling_z,
                          const FootholdSearch& ground) {
  const Eigen::Vector3d here = at(share);
  const double top_here = topAt(share);
  const Eigen::Vector3d start(here.x(), here.y(), from_.z());
  const double top = highestBetween(start, to, ceiling_z, ground) + clearance_m_;
  const double across = smoothStep(share, kLeave, kArrive);
  from_.head<2>() = (here - across * to).head<2>() / (1.0 - across);
  to_ = to;
  top_z_ = top_here;
  rise_m_ = std::max(0.0, top - top_here);
  rise_from_ = share;
}

double SwingCurve::topAt(double share) const {
  return top_z_ + rise_m_ * smoothStep(share, rise_from_, kSink);
}

Eigen::Vector3d SwingCurve::at(double share) const {
  const double across = smoothStep(share, kLeave, kArrive);
  Eigen::Vector3d foot = from_ + across * (to_ - from_);
  foot.z() = share < kSink
                 ? from_.z() + smoothStep(share, 0.0, kRise) * (topAt(share) - from_.z())
                 : topAt(share) + smoothStep(share, kSink, 1.0) * (to_.z() - topAt(share));
  return foot;
}

bool SwingCurve::crosses(double share) { return share > kLeave && share < kArrive; }

}  // namespace spelunk::sim
