#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/rng.h"
#include "spelunk/map/frozen_map.h"

namespace spelunk::map {

/// Draws points uniformly from the known free volume of a whole map, without a dense copy of it:
/// what a gallery in a large box needs, where almost every draw from the box would be lost. The
/// same map and stream give the same points, whatever the order its parts were seen in.
class FreeVoxels {
 public:
  /// Only voxels whose centres lie in `region` are drawn. Holds the map alive.
  FreeVoxels(std::shared_ptr<const FrozenMap> map, const AxisAlignedBox& region);

  /// Empty if nothing in the region is free.
  [[nodiscard]] std::optional<Eigen::Vector3d> draw(Rng& rng) const;

 private:
  [[nodiscard]] VoxelIndex voxel(std::size_t number) const;

  std::shared_ptr<const FrozenMap> map_;
  AxisAlignedBox region_;
  std::vector<std::size_t> chunks_;  ///< Numbers of the chunks that meet the region, by key.
  std::vector<std::size_t> before_;  ///< Free voxels in the chunks before each, and in all.
};

}  // namespace spelunk::map
