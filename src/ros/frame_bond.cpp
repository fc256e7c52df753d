#include "spelunk/ros/frame_bond.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace spelunk::bridge {
namespace {

constexpr std::size_t kDeepestTree = 100;  // a loop in a broken tree ends here
constexpr double kTurn_rad = 0.35;         // more than any noise of odometry
constexpr double kStays = 0.25;            // of the base's motion: a frame that moves less stays

bool holds(const std::vector<std::string>& frames, const std::string& frame) {
  return std::find(frames.begin(), frames.end(), frame) != frames.end();
}

/// A frame and all frames above it.
std::vector<std::string> lineOf(const std::string& frame, const FrameBonds::ParentLookup& parent) {
  std::vector<std::string> line{frame};
  while (line.size() < kDeepestTree) {
    const auto above = parent(line.back());
    if (!above) break;
    line.push_back(*above);
  }
  return line;
}

double angleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

double distanceBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

}  // namespace

FrameBonds::FrameBonds(const std::string& world_frame, double reach_m, double motion_m,
                       ParentLookup parent)
    : world_frame_(world_frame),
      reach_m_(reach_m),
      motion_m_(motion_m),
      parent_(std::move(parent)) {}

void FrameBonds::noteOdometry(const std::string& frame, const std::string& base_frame) {
  if (frame != odometry_frame_ || base_frame != base_frame_) seen_.clear();
  odometry_frame_ = frame;
  base_frame_ = base_frame;
}

FrameBond FrameBonds::bondOf(const std::string& frame, const Eigen::Isometry3d& T_world_frame,
                             const Eigen::Isometry3d& T_world_base) {
  const FrameBond by_tree = bondByTree(frame);
  if (by_tree != FrameBond::kUndecided) return by_tree;
  return bondByMotion(frame, T_world_frame, T_world_base);
}

/// Frames at or above those of world and odometry stay, the base and frames below it move. Between
/// them (base_footprint, odom under map) and beside them there are both kinds.
FrameBond FrameBonds::bondByTree(const std::string& frame) const {
  for (const std::string& top : {world_frame_, odometry_frame_})
    if (holds(lineOf(top, parent_), frame)) return FrameBond::kFixed;
  const bool hangs_on_base = !base_frame_.empty() && holds(lineOf(frame, parent_), base_frame_);
  return hangs_on_base ? FrameBond::kCarried : FrameBond::kUndecided;
}

FrameBond FrameBonds::bondByMotion(const std::string& frame, const Eigen::Isometry3d& T_world_frame,
                                   const Eigen::Isometry3d& T_world_base) {
  const Seen now{T_world_frame, T_world_base, FrameBond::kUndecided};
  if (distanceBetween(T_world_frame, T_world_base) > reach_m_) return FrameBond::kFixed;
  Seen& seen = seen_.try_emplace(frame, now).first->second;
  const double moved_m = distanceBetween(seen.T_world_base, T_world_base);
  const double turned_rad = angleBetween(seen.T_world_base, T_world_base);
  if (moved_m < motion_m_ && turned_rad < kTurn_rad) return seen.bond;
  const bool stays = moved_m >= motion_m_
                         ? distanceBetween(seen.T_world_frame, T_world_frame) < kStays * moved_m
                         : angleBetween(seen.T_world_frame, T_world_frame) < kStays * turned_rad;
  seen = now;
  seen.bond = stays ? FrameBond::kFixed : FrameBond::kCarried;
  return seen.bond;
}

}  // namespace spelunk::bridge
