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

  void unmarkHit(PackedKey voxel) {
    blocks_[touch(voxel)].hit[static_cast<std::size_t>(wordOf(voxel))] &=
        ~(std::uint64_t{1} << bitOf(voxel));
  }

  [[nodiscard]] Block& block(std::size_t i) { return blocks_[i]; }
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }

 private:
  std::vector<Block> blocks_;
  std::size_t last_ = 0;  ///< Touched last: neighbours in a scan often share it.
  KeyTable table_{12};
};

}  // namespace spelunk::map
