#include "spelunk/map/free_voxels.h"

#include <algorithm>

#include "frozen_blocks.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr int kDrawsMax = 1000;  // until one lies in the region; only its rim's chunks need several

std::size_t countOf(std::uint64_t bits) {
  return static_cast<std::size_t>(__builtin_popcountll(bits));
}

std::size_t freeIn(const StatusChunk& chunk) {
  std::size_t count = 0;
  for (const StatusBlock& block : chunk.blocks)
    for (std::size_t z = 0; z < kBlockSide; ++z)
      count += countOf(block.known[z] & ~block.occupied[z]);
  return count;
}

bool meets(const StatusChunk& chunk, const AxisAlignedBox& region, double resolution_m) {
  const Eigen::Vector3d low = resolution_m * unpackIndex(chunk.key).cast<double>();
  const Eigen::Vector3d high = low + Eigen::Vector3d::Constant(32.0 * resolution_m);
  return !intersection({low, high}, region).isEmpty();
}

/// The bit of a word that has `rank` set bits below it.
int bitOfRank(std::uint64_t bits, std::size_t rank) {
  for (; rank > 0; --rank) bits &= bits - 1;
  return __builtin_ctzll(bits);
}

}  // namespace

FreeVoxels::FreeVoxels(std::shared_ptr<const FrozenMap> map, const AxisAlignedBox& region)
    : map_(std::move(map)), region_(region) {
  require(map_ != nullptr, "FreeVoxels: no map");
  const auto& all = map_->blocks().chunks;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (meets(*all[i], region, map_->resolution())) chunks_.push_back(i);
  std::sort(chunks_.begin(), chunks_.end(),
            [&](std::size_t a, std::size_t b) { return all[a]->key < all[b]->key; });
  before_.push_back(0);
  for (const std::size_t i : chunks_) before_.push_back(before_.back() + freeIn(*all[i]));
}

VoxelIndex FreeVoxels::voxel(std::size_t number) const {
  const auto next = std::upper_bound(before_.begin(), before_.end(), number);
  const auto place = static_cast<std::size_t>(next - before_.begin()) - 1;
  std::size_t rank = number - before_[place];
  const StatusChunk& chunk = *map_->blocks().chunks[chunks_[place]];
  for (std::size_t slot = 0; slot < chunk.blocks.size(); ++slot)
    for (std::size_t z = 0; z < kBlockSide; ++z) {
      const std::uint64_t bits = chunk.blocks[slot].known[z] & ~chunk.blocks[slot].occupied[z];
      const std::size_t count = countOf(bits);
      if (rank >= count) {
        rank -= count;
        continue;
      }
      const int bit = bitOfRank(bits, rank);
      const auto s = static_cast<int>(slot);
      return unpackIndex(chunk.key) + 8 * VoxelIndex(s & 3, (s >> 2) & 3, s >> 4) +
             VoxelIndex(bit & 7, bit >> 3, static_cast<int>(z));
    }
  require(false, "FreeVoxels: counts and bits disagree");
  return {};
}

std::optional<Eigen::Vector3d> FreeVoxels::draw(Rng& rng) const {
  const std::size_t count = before_.back();
  if (count == 0) return std::nullopt;
  for (int k = 0; k < kDrawsMax; ++k) {
    const VoxelIndex index = voxel(
        std::min(count - 1, static_cast<std::size_t>(rng.uniform() * static_cast<double>(count))));
    if (!region_.contains(map_->centreOf(index))) continue;
    const double x = rng.uniform();
    const double y = rng.uniform();
    const double z = rng.uniform();
    return (index.cast<double>() + Eigen::Vector3d(x, y, z)) * map_->resolution();
  }
  return std::nullopt;
}

}  // namespace spelunk::map
