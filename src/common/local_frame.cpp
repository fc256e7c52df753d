#include "spelunk/common/local_frame.h"

#include <algorithm>
#include <cstdio>

#include "spelunk/common/contract.h"

namespace spelunk {
namespace {

constexpr double kStep_m = 100.0;
constexpr double kWrittenParts = 1e6;  ///< Of a metre.

}  // namespace

LocalFrame LocalFrame::around(const Eigen::Vector3d& first, double reach_m, double range_m) {
  require(first.allFinite(), "LocalFrame::around: the first place is not finite");
  const double farthest_m = first.lpNorm<Eigen::Infinity>() + reach_m;
  if (farthest_m <= std::min(range_m, kExact_m)) return {};
  const Eigen::Vector3d origin = (first / kStep_m).array().round() * kStep_m;
  return LocalFrame(Eigen::Vector3d(origin + Eigen::Vector3d::Zero()));  // -0 becomes +0
}

Eigen::Vector3d LocalFrame::written(const Eigen::Vector3d& point) const {
  if (isCallers()) return point;
  return (toLocal(point) * kWrittenParts).array().round() / kWrittenParts;
}

LocalFrame LocalFrame::corrected(const Shift& correction) const {
  LocalFrame frame = *this;
  frame.T_caller_local_ = correction.after(T_caller_local_);
  frame.T_caller_local_.about = toLocal(correction.about);
  return frame;
}

std::string sayingOf(const LocalFrame& frame) {
  if (frame.isCallers()) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "far from 0: the map works around an origin of its own, x %.0f, y %.0f, z %.0f m",
                frame.origin().x(), frame.origin().y(), frame.origin().z());
  return text;
}

Pose LocalFrame::written(const Pose& pose) const { return {written(pose.position), pose.yaw}; }

}  // namespace spelunk
