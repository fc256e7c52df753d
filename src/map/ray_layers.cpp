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

  [[nodiscard]] std::uint16_t wordOf(std::size_t ray) const {
    return static_cast<std::uint16_t>(ray / rows_ / 8 * row_patches_ + ray % rows_ / 8);
  }
  [[nodiscard]] std::uint8_t bitOf(std::size_t ray) const {
    return static_cast<std::uint8_t>(ray / rows_ % 8 * 8 + ray % rows_ % 8);
  }

 private:
  std::size_t rows_;
  std::size_t row_patches_;
};

/// One ray's passage through one voxel. Small: a wide field at a small angle has millions of them.
struct Passage {
  std::uint16_t layer;
  TemplateRays::Step step;
  std::uint16_t word;
  std::uint8_t bit;

  [[nodiscard]] auto order() const { return std::tie(layer, step, word); }
  [[nodiscard]] RayLayers::Patch patch() const { return {std::uint64_t{1} << bit, word}; }
};

std::vector<Passage> passagesOf(const TemplateRays& rays) {
  const RayNumbering numbering(rays);
  std::vector<Passage> passages;
  passages.reserve(rays.steps().size());
  for (std::size_t number = 0; number < rays.rays().size(); ++number) {
    const TemplateRays::Ray& ray = rays.rays()[number];
    const std::uint16_t word = numbering.wordOf(number);
    const std::uint8_t bit = numbering.bitOf(number);
    for (std::uint32_t i = ray.begin; i < ray.end; ++i)
      passages.push_back({static_cast<std::uint16_t>(i - ray.begin), rays.steps()[i], word, bit});
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
      const Patch patch = passages[i].patch();
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
