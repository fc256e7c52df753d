#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "spelunk/map/frozen_map.h"

namespace spelunk::map {

/// The frontier of a map that grows: free voxels with at least one unknown neighbour across a face
/// (six neighbours; Akbari 2021, section III, leaves the neighbourhood open). Kept up to date from
/// what differs between one frozen map and the next.
class FrontierVoxels {
 public:
  /// Brings the frontier up to `map`, which must not be null. If it came from the map of the last
  /// call by changes, only the blocks whose status changed and the faces they share with others are
  /// looked at; any other map is taken up as a whole. Keeps `map` until the next call.
  void update(std::shared_ptr<const FrozenMap> map);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] bool contains(const VoxelIndex& index) const;

  /// Those whose centres lie in `region`, in a fixed order that depends on their places only.
  [[nodiscard]] std::vector<VoxelIndex> within(const AxisAlignedBox& region) const;
  [[nodiscard]] std::size_t countWithin(const AxisAlignedBox& region) const;
  [[nodiscard]] std::vector<VoxelIndex> all() const;

  /// Number of the update that last changed anything in or a few metres around `region`; 0 if none
  /// did. While it stays the same, within(region) stays the same.
  [[nodiscard]] std::uint64_t lastChangeNear(const AxisAlignedBox& region) const;

 private:
  struct Chunk;
  template <class Visit>
  void forEachChunkIn(const VoxelIndex& first, const VoxelIndex& last, Visit&& visit) const;
  template <class Visit>
  void forEachBlockIn(const AxisAlignedBox& region, Visit&& visit) const;
  void recompute(std::size_t number, std::uint64_t slots);

  std::shared_ptr<const FrozenMap> map_;
  std::vector<std::shared_ptr<Chunk>> chunks_;  ///< Numbered as the map's.
  std::size_t count_ = 0;
  std::uint64_t updates_ = 0;
};

}  // namespace spelunk::map
