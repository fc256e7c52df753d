#pragma once

#include <vector>

#include "voxel_key.h"

namespace spelunk::map {

/// How often voxels were looked into while nothing came back from there. A voxel that was looked
/// into from kLooks places is silent. Whether it became known meanwhile is not kept here.
class SilentVoxels {
 public:
  static constexpr int kLooks = 3;  ///< The counters hold two bits.

  /// Counts one look for each of these voxels; once for those that are listed twice.
  void countLook(std::vector<PackedKey> voxels);

  /// The silent voxels of the block around a voxel.
  [[nodiscard]] Mask silentIn(PackedKey voxel) const;

  /// All of them, in a fixed order.
  [[nodiscard]] std::vector<PackedKey> all() const;

  /// Keys of the blocks in which a voxel became silent since the last call, in a fixed order.
  std::vector<PackedKey> takeChanges();

  [[nodiscard]] std::size_t memoryBytes() const;

 private:
  struct Block {
    PackedKey key = 0;
    Mask low{};  ///< Of the two bits of each voxel's count.
    Mask high{};
    bool is_listed = false;
  };
  Block& blockOf(PackedKey key);
  [[nodiscard]] static Mask silentIn(const Block& block);

  std::vector<Block> blocks_;
  KeyTable table_;
  std::vector<PackedKey> changes_;
};

}  // namespace spelunk::map
