#include "spelunk/map/volumetric_gain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include "distinct_count.h"
#include "ray_layers.h"
#include "spelunk/common/contract.h"
#include "template_rays.h"
#include "voxel_key.h"

namespace spelunk::map {
namespace {

/// Steps of all sensors as distances in the cells of a window of a certain size.
struct CellOffsets {
  VoxelIndex window_size;
  std::vector<std::vector<std::int32_t>> sensors;
  std::vector<std::vector<std::int32_t>> layers;  ///< Where distinct voxels are counted.
};

std::vector<std::int32_t> offsetsOf(const std::vector<TemplateRays::Step>& steps,
                                    const VoxelIndex& window_size) {
  const std::int64_t row = window_size.x();
  const std::int64_t plane = row * window_size.y();
  std::vector<std::int32_t> offsets;
  offsets.reserve(steps.size());
  for (const TemplateRays::Step& step : steps)
    offsets.push_back(static_cast<std::int32_t>(step[0] + row * step[1] + plane * step[2]));
  return offsets;
}

/// Voxels of the window whose centres lie in `bounds`, relative to `start`.
TemplateRays::Range reachableFrom(const VoxelIndex& start, const LocalWindow& window,
                                  const AxisAlignedBox& bounds) {
  TemplateRays::Range reachable;
  for (int i = 0; i < 3; ++i) {
    const int first = window.origin()(i);
    const IndexRange range = centresIn(bounds.min(i), bounds.max(i), window.resolution(),
                                       {first, first + window.size()(i) - 1});
    reachable.first(i) = range.first - start(i);
    reachable.last(i) = range.last - start(i);
  }
  return reachable;
}

/// The part of `reachable` outside which the window knows nothing; all of it if the rays start in
/// unknown space, for then they may enter the known part later.
TemplateRays::Range knownFrom(const VoxelIndex& start, const LocalWindow& window,
                              const TemplateRays::Range& reachable) {
  const TemplateRays::Range known{window.knownFirst() - start, window.knownLast() - start};
  if (!known.contains(VoxelIndex::Zero())) return reachable;
  return {known.first.cwiseMax(reachable.first), known.last.cwiseMin(reachable.last)};
}

/// Counts the free among the lowest `count` of eight cells, none of which is occupied.
int freeAmong(std::uint64_t cells, int count) {
  const std::uint64_t kept = count == 8 ? cells : cells & ((std::uint64_t{1} << (8 * count)) - 1);
  return static_cast<int>((kept * 0x0101010101010101u) >> 56);
}

constexpr std::size_t kGathered = 8;
constexpr std::uint64_t kOccupiedBits = 0x0202020202020202u;
constexpr std::uint64_t kFreeBits = 0x0101010101010101u;

/// Up to eight cells of a ray, one a byte: a branch a cell would cost more than gathering them.
inline std::uint64_t gather(const std::uint8_t* start, const std::int32_t* offsets,
                            std::size_t count) {
  std::uint64_t gathered = 0;
  if (count == kGathered)
    for (std::size_t k = 0; k < kGathered; ++k)
      gathered |= std::uint64_t{start[offsets[k]]} << (8 * k);
  else
    for (std::size_t k = 0; k < count; ++k) gathered |= std::uint64_t{start[offsets[k]]} << (8 * k);
  return gathered;
}

/// Adds the cells up to the first occupied one; whether there was none.
bool countRay(const std::uint8_t* start, const std::int32_t* offsets, std::size_t count,
              VolumetricGain& gain) {
  int seen = 0;
  int free = 0;
  bool is_open = true;
  for (std::size_t i = 0; i < count && is_open; i += kGathered) {
    const std::size_t cells = std::min(kGathered, count - i);
    const std::uint64_t gathered = gather(start, offsets + i, cells);
    const std::uint64_t occupied = gathered & kOccupiedBits;
    const int before = occupied == 0 ? static_cast<int>(cells) : __builtin_ctzll(occupied) / 8;
    seen += before;
    free += freeAmong(gathered, before);
    if (occupied != 0) {
      ++gain.occupied_voxels;
      is_open = false;
    }
  }
  gain.free_voxels += free;
  gain.unknown_voxels += seen - free;
  return is_open;
}

/// The cone around a ray: one entry a step, for where the ray enters its voxel, and one for the
/// end.
struct Cone {
  const float* volumes;
  const float* lengths;
  float depth;  ///< How far beyond the first unknown voxel the ray counts; in voxels.
};

/// Follows one ray for the volume of its cone.
class ConeCount {
 public:
  ConeCount(const Cone& cone, VolumetricGain& gain) : cone_(cone), gain_(gain) {}

  /// Takes `count` steps through a window; false if the ray ended.
  bool takeSteps(const std::uint8_t* start, const std::int32_t* offsets, std::size_t count) {
    for (std::size_t i = 0; i < count; i += kGathered) {
      const std::size_t cells = std::min(kGathered, count - i);
      const std::uint64_t gathered = gather(start, offsets + i, cells);
      const std::uint64_t not_free = gathered ^ kFreeBits;  // cells beyond the last count as such
      const std::size_t free = not_free == 0 ? kGathered : __builtin_ctzll(not_free) / 8U;
      gain_.free_voxels += static_cast<int>(free);
      for (std::size_t k = i + free; k < i + cells; ++k)
        if (!takeStep(static_cast<Occupancy>((gathered >> (8 * (k - i))) & 3), k)) return false;
    }
    return true;
  }

  /// Takes steps `from` up to `to`, all of them unknown.
  void takeUnknown(std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
      if (!takeStep(Occupancy::kUnknown, k)) return;
  }

 private:
  bool takeStep(Occupancy status, std::size_t k) {
    if (status == Occupancy::kFree) {
      ++gain_.free_voxels;
      return true;
    }
    if (status == Occupancy::kOccupied) {
      ++gain_.occupied_voxels;
      return false;
    }
    limit_ = std::min(limit_, cone_.lengths[k] + cone_.depth);
    if (cone_.lengths[k] >= limit_) return false;
    ++gain_.unknown_voxels;
    gain_.unknown_m3 +=
        static_cast<double>(cone_.volumes[k + 1]) - static_cast<double>(cone_.volumes[k]);
    return true;
  }

  const Cone& cone_;
  VolumetricGain& gain_;
  float limit_ = std::numeric_limits<float>::infinity();  ///< Once unknown space is entered.
};

}  // namespace

struct GainEvaluator::Impl {
  [[nodiscard]] std::shared_ptr<const CellOffsets> offsetsFor(const VoxelIndex& window_size);
  void countSensor(std::size_t sensor, const LocalWindow& window, const VoxelIndex& start,
                   double yaw, const AxisAlignedBox& bounds, const CellOffsets& offsets,
                   SeenCells* seen, VolumetricGain& gain) const;

  double resolution_m = 0.2;
  double reach_m = 0.0;
  GainCounting counting = GainCounting::kDistinct;
  float depth_voxels = std::numeric_limits<float>::infinity();
  std::vector<TemplateRays> sensors;
  std::vector<std::optional<RayLayers>> layers;  ///< Where distinct voxels are counted all around.
  std::mutex mutex;                              ///< Guards `last_offsets` only.
  std::shared_ptr<const CellOffsets> last_offsets;
};

std::shared_ptr<const CellOffsets> GainEvaluator::Impl::offsetsFor(const VoxelIndex& window_size) {
  const std::lock_guard lock(mutex);
  if (last_offsets != nullptr && last_offsets->window_size.head<2>() == window_size.head<2>())
    return last_offsets;
  auto offsets = std::make_shared<CellOffsets>();
  offsets->window_size = window_size;
  for (const TemplateRays& sensor : sensors)
    offsets->sensors.push_back(offsetsOf(sensor.steps(), window_size));
  for (const std::optional<RayLayers>& rays : layers)
    offsets->layers.push_back(rays ? offsetsOf(rays->steps(), window_size)
                                   : std::vector<std::int32_t>{});
  last_offsets = std::move(offsets);
  return last_offsets;
}

void GainEvaluator::Impl::countSensor(std::size_t sensor, const LocalWindow& window,
                                      const VoxelIndex& start, double yaw,
                                      const AxisAlignedBox& bounds, const CellOffsets& offsets,
                                      SeenCells* seen, VolumetricGain& gain) const {
  const TemplateRays::Range reachable = reachableFrom(start, window, bounds);
  if (!reachable.contains(VoxelIndex::Zero())) return;
  const TemplateRays::Range known = knownFrom(start, window, reachable);
  const TemplateRays& rays = sensors[sensor];
  const TemplateRays::Heading heading = rays.headingAt(yaw);
  const std::size_t start_cell = window.offsetOf(start - window.origin());
  const std::uint8_t* start_cells = window.cells() + start_cell;
  if (layers[sensor])
    return countLayersOnce(*layers[sensor], offsets.layers[sensor], reachable, window.cells(),
                           start_cell, seen, gain);
  std::size_t number = heading.first;
  for (std::size_t i = 0; i < heading.count; ++i) {
    const TemplateRays::Ray& ray = rays.rays()[number];
    if (++number == rays.rays().size()) number = 0;
    const std::int32_t* cells = offsets.sensors[sensor].data() + ray.begin;
    const std::size_t count = rays.stepsInside(ray, reachable);
    if (seen != nullptr) {
      countRayOnce(window.cells(), start_cell, cells, count, *seen, gain);
      continue;
    }
    const std::size_t known_count = rays.stepsInside(ray, known);
    if (counting == GainCounting::kCone) {
      const Cone cone{rays.coneVolumes().data() + ray.cone, rays.coneLengths().data() + ray.cone,
                      depth_voxels};
      ConeCount counted(cone, gain);
      if (counted.takeSteps(start_cells, cells, known_count))
        counted.takeUnknown(known_count, count);
      continue;
    }
    if (countRay(start_cells, cells, known_count, gain))
      gain.unknown_voxels += static_cast<int>(count - known_count);
  }
}

GainEvaluator::GainEvaluator(const std::vector<SensorModel>& sensors, double resolution_m,
                             GainCounting counting, double cone_depth_m)
    : impl_(std::make_unique<Impl>()) {
  require(std::isfinite(resolution_m) && resolution_m > 0.0, "GainEvaluator: bad resolution");
  impl_->resolution_m = resolution_m;
  require(cone_depth_m > 0.0, "GainEvaluator: the depth of cones must be positive");
  impl_->counting = counting;
  impl_->depth_voxels = static_cast<float>(cone_depth_m / resolution_m);
  for (const SensorModel& sensor : sensors) {
    const TemplateRays& rays = impl_->sensors.emplace_back(sensor, resolution_m);
    const bool is_circle = rays.headingAt(0.0).count == rays.rays().size();
    impl_->layers.emplace_back();
    if (counting == GainCounting::kDistinct && is_circle) impl_->layers.back().emplace(rays);
    impl_->reach_m =
        std::max(impl_->reach_m, sensor.gain_range_m + sensor.mount_m.norm() + resolution_m);
  }
}
GainEvaluator::~GainEvaluator() = default;
GainEvaluator::GainEvaluator(GainEvaluator&&) noexcept = default;

VolumetricGain GainEvaluator::evaluate(const LocalWindow& window, const Eigen::Vector3d& position,
                                       double yaw, const AxisAlignedBox& bounds) const {
  require(position.allFinite() && std::isfinite(yaw), "GainEvaluator: pose is not finite");
  require(std::fabs(window.resolution() - impl_->resolution_m) < 1e-9,
          "GainEvaluator: window of another resolution");
  VolumetricGain gain;
  const auto offsets = impl_->offsetsFor(window.size());
  const bool is_only_layers = impl_->sensors.size() == 1 && impl_->layers.front();
  // The layers of one sensor hold each voxel once: nothing needs to be remembered.
  const bool remembers = impl_->counting == GainCounting::kDistinct && !is_only_layers;
  SeenCells seen(remembers ? window.cellCount() : 0);
  const Eigen::AngleAxisd R_world_base(yaw, Eigen::Vector3d::UnitZ());
  for (std::size_t i = 0; i < impl_->sensors.size(); ++i) {
    const Eigen::Vector3d origin = position + R_world_base * impl_->sensors[i].mount();
    impl_->countSensor(i, window, window.indexOf(origin), yaw, bounds, *offsets,
                       remembers ? &seen : nullptr, gain);
  }
  if (impl_->counting != GainCounting::kCone) gain.unknown_m3 = gain.unknown_voxels;
  gain.unknown_m3 *= std::pow(impl_->resolution_m, 3);
  return gain;
}

double GainEvaluator::reach() const { return impl_->reach_m; }

}  // namespace spelunk::map
