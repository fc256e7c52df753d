#include "spelunk/ros/pose_track.h"

#include <algorithm>

namespace spelunk::bridge {

void PoseTrack::add(double stamp_s, const Eigen::Isometry3d& T_world_base) {
  if (!poses_.empty() && stamp_s <= poses_.back().stamp_s) return;
  poses_.push_back({stamp_s, T_world_base});
  while (poses_.front().stamp_s < stamp_s - kKept_s) poses_.pop_front();
}

std::optional<Eigen::Isometry3d> PoseTrack::at(double stamp_s) const {
  if (poses_.empty() || stamp_s < poses_.front().stamp_s || stamp_s > poses_.back().stamp_s)
    return std::nullopt;
  const auto after = std::lower_bound(
      poses_.begin(), poses_.end(), stamp_s,
      [](const Stamped& pose, double wanted_s) { return pose.stamp_s < wanted_s; });
  if (after == poses_.begin()) return after->T_world_base;
  const auto before = std::prev(after);
  const double share = (stamp_s - before->stamp_s) / (after->stamp_s - before->stamp_s);
  const Eigen::Quaterniond from(before->T_world_base.linear());
  const Eigen::Quaterniond to(after->T_world_base.linear());
  Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
  T_world_base.linear() = from.slerp(share, to).toRotationMatrix();
  T_world_base.translation() = (1.0 - share) * before->T_world_base.translation() +
                               share * after->T_world_base.translation();
  return T_world_base;
}

std::optional<Eigen::Isometry3d> PoseTrack::nearest(double stamp_s) const {
  if (poses_.empty()) return std::nullopt;
  return at(std::clamp(stamp_s, poses_.front().stamp_s, poses_.back().stamp_s));
}

void PoseTrack::move(const Shift& shift) {
  for (Stamped& pose : poses_) pose.T_world_base = moved(pose.T_world_base, shift);
}

}  // namespace spelunk::bridge
