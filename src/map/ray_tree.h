#pragma once

#include <cstdint>
#include <vector>

#include "template_rays.h"

namespace spelunk::map {

/// The rays of a full circle as one tree: steps that rays have in common from their start are held
/// once. In the order of a walk that goes down before it goes aside, so that a node's successor is
/// its child, and what follows its whole branch stands in `after`.
class RayTree {
 public:
  explicit RayTree(const TemplateRays& rays);

  [[nodiscard]] const std::vector<TemplateRays::Step>& steps() const { return steps_; }
  /// For each node: where to go on if the ray ends there.
  [[nodiscard]] const std::vector<std::uint32_t>& after() const { return after_; }
  /// Around all steps, offset 0 included.
  [[nodiscard]] const TemplateRays::Range& extent() const { return extent_; }

 private:
  struct Branches;
  void lay(const Branches& branches, std::uint32_t node);

  std::vector<TemplateRays::Step> steps_;
  std::vector<std::uint32_t> after_;
  TemplateRays::Range extent_{VoxelIndex::Zero(), VoxelIndex::Zero()};
};

}  // namespace spelunk::map
