#pragma once

#include <vector>

#include "voxel_key.h"

namespace spelunk::map {

/// The voxels one scan saw, as bits in the blocks it touched, in the order of first touch.
class ScanMarks {
 public:
  struct Block {
    PackedKey key;  ///< Of the block's first voxel.
    Mask free;
    Mask hit;
  };

  void clear() {
    blocks_.clear();
    table_.clear();
  }

  /// Index of the block around a voxel, added if new.
  std::size_t touch(PackedKey voxel) {
    const PackedKey key = voxel & ~kInBlockMask;
    if (last_ < blocks_.size() && blocks_[last_].key == key) return last_;
    const std::uint32_t found = table_.find(key);
    if (found != KeyTable::kAbsent) return last_ = found;
    last_ = blocks_.size();
    table_.insert(key, static_cast<std::uint32_t>(last_));
    blocks_.push_back({key, {}, {}});
    return last_;
  }

  /// Marks a hit voxel; false if it was marked before.
  bool markHit(PackedKey voxel) {
    std::uint64_t& word = blocks_[touch(voxel)].hit[static_cast<std::size_t>(wordOf(voxel))];
    const std::uint64_t bit = std::uint64_t{1} << bitOf(voxel);
    const bool is_new = (word & bit) == 0;
    word |= bit;
    return is_new;
  }

  [[nodiscard]] Block& block(std::size_t i) { return blocks_[i]; }
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }

 private:
  std::vector<Block> blocks_;
  std::size_t last_ = 0;  ///< Touched last: neighbours in a scan often share it.
  KeyTable table_{12};
};

/// The voxels OctoMap would update for one scan (Hornung et al., OctoMap, Autonomous Robots 2013,
/// section 5): same arithmetic, so the same voxels bit for bit.
class ScanTracer {
 public:
  /// The origin's key must be in range with a margin of one block.
  ScanTracer(const Eigen::Vector3f& origin, double resolution_m, double range_max_m);

  /// Marks the ray to `end`: free up to it and hit at it, or free up to the range if it is longer.
  /// `end` must be in key range with a margin of one block.
  void trace(const Eigen::Vector3f& end, ScanMarks& marks) const;

  /// The centre of the voxel around `point`, as OctoMap rounds it.
  [[nodiscard]] Eigen::Vector3f centreAround(const Eigen::Vector3f& point) const;
  [[nodiscard]] PackedKey keyOf(const Eigen::Vector3f& point) const;

 private:
  void markFree(const Eigen::Vector3f& end, ScanMarks& marks) const;

  Eigen::Vector3f origin_;
  double resolution_m_;
  double inverse_resolution_;
  double range_max_m_;
  PackedKey origin_key_;
};

}  // namespace spelunk::map
