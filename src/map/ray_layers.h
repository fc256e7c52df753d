#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "template_rays.h"

namespace spelunk::map {

/// The rays of a full circle voxel by voxel: each voxel once, with the rays that pass through it as
/// bits. Every step of a ray changes one coordinate by one, so a voxel is reached after the same
/// number of steps by all of its rays: sorted by that number, no voxel needs to know of a later
/// one.
class RayLayers {
 public:
  /// Rays of one word (a patch of eight by eight directions) that pass through a voxel.
  struct Patch {
    std::uint64_t rays;
    std::uint16_t word;
  };
  /// Small, for all of them are read for every gain.
  struct Voxel {
    std::array<std::uint64_t, 2> rays;  ///< Of its first two patches; 0 where there is none.
    std::array<std::uint16_t, 2> words;
    std::uint32_t more_end;  ///< Its other patches end here; they begin where those before end.
  };

  explicit RayLayers(const TemplateRays& rays);

  [[nodiscard]] const std::vector<Voxel>& voxels() const { return voxels_; }
  /// Offsets of the voxels.
  [[nodiscard]] const std::vector<TemplateRays::Step>& steps() const { return steps_; }
  [[nodiscard]] const std::vector<Patch>& morePatches() const { return more_patches_; }
  /// One bit a ray, as many words as patches name.
  [[nodiscard]] std::size_t words() const { return words_; }
  /// Around all steps, offset 0 included.
  [[nodiscard]] const TemplateRays::Range& extent() const { return extent_; }

 private:
  void add(const TemplateRays::Step& step, const std::vector<Patch>& patches);

  std::vector<Voxel> voxels_;
  std::vector<TemplateRays::Step> steps_;
  std::vector<Patch> more_patches_;
  std::size_t words_ = 0;
  TemplateRays::Range extent_{VoxelIndex::Zero(), VoxelIndex::Zero()};
};

}  // namespace spelunk::map
