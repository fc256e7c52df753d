#include "ray_tree.h"

#include <algorithm>

namespace spelunk::map {

/// The tree while it grows: a node's children are chained.
struct RayTree::Branches {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Node {
    TemplateRays::Step step{};
    std::uint32_t first_child = kNone;
    std::uint32_t last_child = kNone;
    std::uint32_t next_sibling = kNone;
  };
  std::vector<Node> nodes{Node{}};  ///< The root is the start of all rays.

  std::uint32_t childOf(std::uint32_t parent, const TemplateRays::Step& step) {
    for (std::uint32_t child = nodes[parent].first_child; child != kNone;
         child = nodes[child].next_sibling)
      if (nodes[child].step == step) return child;
    const auto child = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back({step, kNone, kNone, kNone});
    if (nodes[parent].first_child == kNone)
      nodes[parent].first_child = child;
    else
      nodes[nodes[parent].last_child].next_sibling = child;
    nodes[parent].last_child = child;
    return child;
  }
};

RayTree::RayTree(const TemplateRays& rays) {
  Branches branches;
  for (const TemplateRays::Ray& ray : rays.rays()) {
    std::uint32_t node = 0;
    for (std::uint32_t i = ray.begin; i < ray.end; ++i)
      node = branches.childOf(node, rays.steps()[i]);
  }
  steps_.reserve(branches.nodes.size());
  after_.reserve(branches.nodes.size());
  for (std::uint32_t child = branches.nodes[0].first_child; child != Branches::kNone;
       child = branches.nodes[child].next_sibling)
    lay(branches, child);
}

void RayTree::lay(const Branches& branches, std::uint32_t node) {
  const std::size_t at = steps_.size();
  const TemplateRays::Step& step = branches.nodes[node].step;
  steps_.push_back(step);
  after_.push_back(0);
  const VoxelIndex offset(step[0], step[1], step[2]);
  extent_.first = extent_.first.cwiseMin(offset);
  extent_.last = extent_.last.cwiseMax(offset);
  for (std::uint32_t child = branches.nodes[node].first_child; child != Branches::kNone;
       child = branches.nodes[child].next_sibling)
    lay(branches, child);
  after_[at] = static_cast<std::uint32_t>(steps_.size());
}

}  // namespace spelunk::map
