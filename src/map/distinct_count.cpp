#include "distinct_count.h"

namespace spelunk::map {
namespace {

/// Which rays have not met anything yet, a bit each; kept a thread.
class OpenRays {
 public:
  explicit OpenRays(const RayLayers& layers) : more_(layers.morePatches().data()) {
    thread_local std::vector<std::uint64_t> bits;
    bits.assign(layers.words(), ~std::uint64_t{0});
    bits_ = bits.data();
  }

  [[nodiscard]] bool anyOf(const RayLayers::Voxel& voxel, std::uint32_t more_begin) const {
    std::uint64_t open = bits_[voxel.words[0]] & voxel.rays[0];
    open |= bits_[voxel.words[1]] & voxel.rays[1];
    for (std::uint32_t i = more_begin; i < voxel.more_end; ++i)
      open |= bits_[more_[i].word] & more_[i].rays;
    return open != 0;
  }
  void close(const RayLayers::Voxel& voxel, std::uint32_t more_begin) {
    bits_[voxel.words[0]] &= ~voxel.rays[0];
    bits_[voxel.words[1]] &= ~voxel.rays[1];
    for (std::uint32_t i = more_begin; i < voxel.more_end; ++i)
      bits_[more_[i].word] &= ~more_[i].rays;
  }

 private:
  const RayLayers::Patch* more_;
  std::uint64_t* bits_ = nullptr;
};

/// Statuses counted side by side in one register.
class StatusCounts {
 public:
  void add(std::uint8_t status, std::uint64_t count) { counts_ += count << (kBits * status); }
  [[nodiscard]] int of(Occupancy status) const {
    constexpr std::uint64_t kOnes = (std::uint64_t{1} << kBits) - 1;
    return static_cast<int>((counts_ >> (kBits * static_cast<int>(status))) & kOnes);
  }

 private:
  static constexpr int kBits = 21;
  std::uint64_t counts_ = 0;
};

/// The voxels that open rays reach, by status. Voxels that are not `isReachable` end their rays;
/// `isNew` says 1 for a voxel that no sensor has counted yet.
template <class IsReachable, class IsNew>
StatusCounts countLayers(const RayLayers& layers, const std::int32_t* offsets,
                         const std::uint8_t* start, const IsReachable& is_reachable,
                         const IsNew& is_new) {
  StatusCounts counts;
  OpenRays open(layers);
  const RayLayers::Voxel* voxels = layers.voxels().data();
  const std::size_t count = layers.voxels().size();
  std::uint32_t more_begin = 0;
  for (std::size_t i = 0; i < count; more_begin = voxels[i++].more_end) {
    if (!open.anyOf(voxels[i], more_begin)) continue;
    if (!is_reachable(i)) {
      open.close(voxels[i], more_begin);
      continue;
    }
    const std::uint8_t status = start[offsets[i]];
    counts.add(status, is_new(offsets[i]));
    if (static_cast<Occupancy>(status) == Occupancy::kOccupied) open.close(voxels[i], more_begin);
  }
  return counts;
}

}  // namespace

void countRayOnce(const std::uint8_t* window, std::size_t start, const std::int32_t* offsets,
                  std::size_t count, SeenCells& seen, VolumetricGain& gain) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = start + static_cast<std::size_t>(static_cast<std::int64_t>(offsets[i]));
    const auto status = static_cast<Occupancy>(window[at]);
    if (seen.add(at) != 0) {
      gain.unknown_voxels += status == Occupancy::kUnknown ? 1 : 0;
      gain.occupied_voxels += status == Occupancy::kOccupied ? 1 : 0;
      gain.free_voxels += status == Occupancy::kFree ? 1 : 0;
    }
    if (status == Occupancy::kOccupied) return;
  }
}

void countLayersOnce(const RayLayers& layers, const std::vector<std::int32_t>& offsets,
                     const TemplateRays::Range& reachable, const std::uint8_t* cells,
                     std::size_t start, SeenCells* seen, VolumetricGain& gain) {
  const auto isInReach = [&](std::size_t i) {
    const TemplateRays::Step& step = layers.steps()[i];
    return reachable.contains({step[0], step[1], step[2]});
  };
  const auto isAlwaysInReach = [](std::size_t) { return true; };
  const auto isNew = [](std::int32_t) { return std::uint64_t{1}; };
  const auto isUnseen = [&](std::int32_t offset) {
    return seen->add(start + static_cast<std::size_t>(static_cast<std::int64_t>(offset)));
  };
  const bool is_all_reachable =
      reachable.contains(layers.extent().first) && reachable.contains(layers.extent().last);
  const auto count = [&](const auto& is_new) {
    return is_all_reachable
               ? countLayers(layers, offsets.data(), cells + start, isAlwaysInReach, is_new)
               : countLayers(layers, offsets.data(), cells + start, isInReach, is_new);
  };
  const StatusCounts counts = seen == nullptr ? count(isNew) : count(isUnseen);
  gain.unknown_voxels += counts.of(Occupancy::kUnknown);
  gain.free_voxels += counts.of(Occupancy::kFree);
  gain.occupied_voxels += counts.of(Occupancy::kOccupied);
}

}  // namespace spelunk::map
