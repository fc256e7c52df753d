#include "ray_layers.h"

#include <algorithm>
#include <tuple>

#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

/// Eight by eight neighbouring directions share a word: a voxel's rays are neighbours.
class RayNumbering {
 public:
  explicit RayNumbering(const TemplateRays& rays)
      : rows_(rays.rows()), row_patches_((rows_ + 7) / 8) {}

  [[nodiscard]] RayLayers::Patch patchOf(std::size_t ray) const {
    const std::size_t column = ray / rows_;
    const std::size_t row = ray % rows_;
    const std::size_t bit = column % 8 * 8 + row % 8;
    return {std::uint64_t{1} << bit,
            static_cast<std::uint16_t>(column / 8 * row_patches_ + row / 8)};
  }

 private:
  std::size_t rows_;
  std::size_t row_patches_;
};

/// One ray's passage through one voxel.
struct Passage {
  int layer;
  TemplateRays::Step step;
  RayLayers::Patch patch;

  [[nodiscard]] auto order() const { return std::tie(layer, step, patch.word); }
};

std::vector<Passage> passagesOf(const TemplateRays& rays) {
  const RayNumbering numbering(rays);
  std::vector<Passage> passages;
  for (std::size_t number = 0; number < rays.rays().size(); ++number) {
    const TemplateRays::Ray& ray = rays.rays()[number];
    const RayLayers::Patch patch = numbering.patchOf(number);
    for (std::uint32_t i = ray.begin; i < ray.end; ++i)
      passages.push_back({static_cast<int>(i - ray.begin), rays.steps()[i], patch});
  }
  std::sort(passages.begin(), passages.end(),
            [](const Passage& a, const Passage& b) { return a.order() < b.order(); });
  return passages;
}

}  // namespace

RayLayers::RayLayers(const TemplateRays& rays) {
  require(rays.rays().size() < (1U << 20),
          "RayLayers: too many rays; gain_resolution_deg is too fine");
  const std::vector<Passage> passages = passagesOf(rays);
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < passages.size();) {
    const TemplateRays::Step& step = passages[i].step;
    patches.clear();
    for (; i < passages.size() && passages[i].step == step; ++i) {
      const Patch& patch = passages[i].patch;
      if (!patches.empty() && patches.back().word == patch.word)
        patches.back().rays |= patch.rays;
      else
        patches.push_back(patch);
      words_ = std::max<std::size_t>(words_, patch.word + 1);
    }
    add(step, patches);
  }
}

void RayLayers::add(const TemplateRays::Step& step, const std::vector<Patch>& patches) {
  Voxel voxel{};
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (i >= voxel.rays.size()) {
      more_patches_.push_back(patches[i]);
      continue;
    }
    voxel.rays[i] = patches[i].rays;
    voxel.words[i] = patches[i].word;
  }
  voxel.more_end = static_cast<std::uint32_t>(more_patches_.size());
  voxels_.push_back(voxel);
  steps_.push_back(step);
  const VoxelIndex offset(step[0], step[1], step[2]);
  extent_.first = extent_.first.cwiseMin(offset);
  extent_.last = extent_.last.cwiseMax(offset);
}

}  // namespace spelunk::map
