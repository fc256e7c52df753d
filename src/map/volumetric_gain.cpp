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
  const std::int64_t column = window_size.z();
  const std::int64_t plane = column * window_size.x();
  std::vector<std::int32_t> offsets;
  offsets.reserve(steps.size());
  for (const TemplateRays::Step& step : steps)
    offsets.push_back(static_cast<std::int32_t>(step[2] + column * step[0] + plane * step[1]));
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

/// Number of free cells before the first other one of `count`.
std::size_t freeBefore(const std::uint8_t* start, const std::int32_t* offsets, std::size_t count) {
  std::size_t i = 0;
  for (; i + kGathered <= count; i += kGathered) {
    const std::uint64_t others = gather(start, offsets + i, kGathered) ^ kFreeBits;
    if (others != 0) return i + static_cast<std::size_t>(__builtin_ctzll(others)) / 8;
  }
  while (i < count && static_cast<Occupancy>(start[offsets[i]]) == Occupancy::kFree) ++i;
  return i;
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

/// Sum of the volumes between steps of cones. It has the bits of adding them step by step, though
/// runs of steps are added at once.
class VolumeSum {
 public:
  /// Adds volumes[k + 1] - volumes[k] for each of the steps from..to-1; volumes never shrink.
  void addRun(const float* volumes, std::size_t from, std::size_t to) {
    // All volumes are multiples of the last bit of the smallest one so far, which has less than
    // 2^24 of them. No sum of up to 2^53 is rounded, in whatever order terms are added.
    constexpr double kExactlySummed = 1 << 29;
    finest_ = std::min(finest_, static_cast<double>(volumes[from]));
    const double sum =
        sum_ + (static_cast<double>(volumes[to]) - static_cast<double>(volumes[from]));
    if (sum <= kExactlySummed * finest_)
      sum_ = sum;
    else
      for (std::size_t k = from; k < to; ++k)
        sum_ += static_cast<double>(volumes[k + 1]) - static_cast<double>(volumes[k]);
  }
  [[nodiscard]] double value() const { return sum_; }

 private:
  double sum_ = 0.0;
  double finest_ = std::numeric_limits<double>::infinity();
};

/// What rays have met so far.
struct Tally {
  VolumetricGain gain;
  VolumeSum cones;
};

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
  ConeCount(const Cone& cone, Tally& tally) : cone_(cone), tally_(tally) {}

  /// Takes steps `from` up to `to` through a window; false if the ray ended.
  bool takeSteps(const std::uint8_t* start, const std::int32_t* offsets, std::size_t from,
                 std::size_t to) {
    for (std::size_t i = from; i < to; i += kGathered) {
      const std::size_t cells = std::min(kGathered, to - i);
      if (!takeGathered(gather(start, offsets + i, cells), i, i + cells)) return false;
    }
    return true;
  }

  /// Takes steps `from` up to `to`, all of them unknown; false if the ray ended.
  bool takeUnknown(std::size_t from, std::size_t to) {
    if (from == to) return true;
    const float* lengths = cone_.lengths;
    limit_ = std::min(limit_, lengths[from] + cone_.depth);
    const bool is_open = lengths[to - 1] < limit_;
    if (!is_open)
      to = static_cast<std::size_t>(std::lower_bound(lengths + from, lengths + to, limit_) -
                                    lengths);
    tally_.gain.unknown_voxels += static_cast<int>(to - from);
    tally_.cones.addRun(cone_.volumes, from, to);
    return is_open;
  }

 private:
  /// Takes steps `from` up to `to`, whose cells are the lowest bytes.
  bool takeGathered(std::uint64_t cells, std::size_t from, std::size_t to) {
    while (from < to) {
      const auto status = static_cast<Occupancy>(cells & 3);
      const std::uint64_t others = cells ^ ((cells & 3) * kFreeBits);
      if (others == 0) return takeRun(status, from, to);
      const std::size_t same = __builtin_ctzll(others) / 8U;
      const std::size_t end = std::min(to, from + same);  // no cells follow: unknown ones seem to
      if (!takeRun(status, from, end)) return false;
      from = end;
      cells >>= 8 * same;
    }
    return true;
  }

  /// Takes steps `from` up to `to`, all of them of one status.
  bool takeRun(Occupancy status, std::size_t from, std::size_t to) {
    if (status == Occupancy::kUnknown) return takeUnknown(from, to);
    if (status == Occupancy::kFree) tally_.gain.free_voxels += static_cast<int>(to - from);
    if (status == Occupancy::kOccupied) ++tally_.gain.occupied_voxels;
    return status == Occupancy::kFree;
  }

  Cone cone_;
  Tally& tally_;
  float limit_ = std::numeric_limits<float>::infinity();  ///< Once unknown space is entered.
};

/// The rays of one sensor from one place of a window.
struct Fan {
  const TemplateRays& rays;
  TemplateRays::Heading heading;
  TemplateRays::Range reachable;
  TemplateRays::Range known;  ///< The part of `reachable` that may hold anything but unknown.
  const std::uint8_t* start;  ///< Cell of the place.
  const std::int32_t* offsets;

  /// Calls `count` with each ray and where its cells lie from the start.
  template <class Count>
  void forEachRay(const Count& count) const {
    std::size_t number = heading.first;
    for (std::size_t i = 0; i < heading.count; ++i) {
      const TemplateRays::Ray& ray = rays.rays()[number];
      if (++number == rays.rays().size()) number = 0;
      count(ray, offsets + ray.begin);
    }
  }
};

void countRays(const Fan& fan, VolumetricGain& gain) {
  fan.forEachRay([&](const TemplateRays::Ray& ray, const std::int32_t* cells) {
    const std::size_t known = fan.rays.stepsInside(ray, fan.known);
    if (countRay(fan.start, cells, known, gain))
      gain.unknown_voxels += static_cast<int>(fan.rays.stepsInside(ray, fan.reachable) - known);
  });
}

void countCones(const Fan& fan, float depth_voxels, Tally& tally) {
  fan.forEachRay([&](const TemplateRays::Ray& ray, const std::int32_t* cells) {
    const std::size_t known = fan.rays.stepsInside(ray, fan.known);
    const std::size_t free = freeBefore(fan.start, cells, known);
    tally.gain.free_voxels += static_cast<int>(free);
    // Most rays meet nothing but free space and a wall.
    if (free < known && static_cast<Occupancy>(fan.start[cells[free]]) == Occupancy::kOccupied) {
      ++tally.gain.occupied_voxels;
      return;
    }
    ConeCount cone({fan.rays.coneVolumes().data() + ray.cone,
                    fan.rays.coneLengths().data() + ray.cone, depth_voxels},
                   tally);
    if (cone.takeSteps(fan.start, cells, free, known))
      cone.takeUnknown(known, fan.rays.stepsInside(ray, fan.reachable));
  });
}

}  // namespace

struct GainEvaluator::Impl {
  [[nodiscard]] std::shared_ptr<const CellOffsets> offsetsFor(const VoxelIndex& window_size);
  void countSensor(std::size_t sensor, const LocalWindow& window, const VoxelIndex& start,
                   double yaw, const AxisAlignedBox& bounds, const CellOffsets& offsets,
                   SeenCells* seen, Tally& tally) const;

  double resolution_m = 0.2;
  double reach_m = 0.0;
  double reach_height_m = 0.0;
  GainCounting counting = GainCounting::kDistinct;
  float depth_voxels = std::numeric_limits<float>::infinity();
  std::vector<TemplateRays> sensors;
  std::vector<std::optional<RayLayers>> layers;  ///< Where distinct voxels are counted all around.
  std::mutex mutex;                              ///< Guards `last_offsets` only.
  std::shared_ptr<const CellOffsets> last_offsets;
};

std::shared_ptr<const CellOffsets> GainEvaluator::Impl::offsetsFor(const VoxelIndex& window_size) {
  const std::lock_guard lock(mutex);
  if (last_offsets != nullptr && last_offsets->window_size == window_size) return last_offsets;
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
                                      SeenCells* seen, Tally& tally) const {
  const TemplateRays::Range reachable = reachableFrom(start, window, bounds);
  if (!reachable.contains(VoxelIndex::Zero())) return;
  const TemplateRays& rays = sensors[sensor];
  const std::size_t start_cell = window.offsetOf(start - window.origin());
  if (layers[sensor])
    return countLayersOnce(*layers[sensor], offsets.layers[sensor], reachable, window.cells(),
                           start_cell, seen, tally.gain);
  const Fan fan{rays,
                rays.headingAt(yaw),
                reachable,
                knownFrom(start, window, reachable),
                window.cells() + start_cell,
                offsets.sensors[sensor].data()};
  if (counting == GainCounting::kCone) return countCones(fan, depth_voxels, tally);
  if (seen == nullptr) return countRays(fan, tally.gain);
  fan.forEachRay([&](const TemplateRays::Ray& ray, const std::int32_t* cells) {
    countRayOnce(window.cells(), start_cell, cells, rays.stepsInside(ray, reachable), *seen,
                 tally.gain);
  });
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
    impl_->layers.emplace_back();
    if (counting == GainCounting::kDistinct && rays.isSameAtAllHeadings())
      impl_->layers.back().emplace(rays);
    impl_->reach_m =
        std::max(impl_->reach_m, gainRange(sensor) + sensor.mount_m.norm() + resolution_m);
    const double height_m = std::max(rays.reachUp(), rays.reachDown());
    impl_->reach_height_m =
        std::max(impl_->reach_height_m, height_m + std::fabs(sensor.mount_m.z()) + resolution_m);
  }
}
GainEvaluator::~GainEvaluator() = default;
GainEvaluator::GainEvaluator(GainEvaluator&&) noexcept = default;

VolumetricGain GainEvaluator::evaluate(const LocalWindow& window, const Eigen::Vector3d& position,
                                       double yaw, const AxisAlignedBox& bounds) const {
  require(position.allFinite() && std::isfinite(yaw), "GainEvaluator: pose is not finite");
  require(std::fabs(window.resolution() - impl_->resolution_m) < 1e-9,
          "GainEvaluator: window of another resolution");
  Tally tally;
  const auto offsets = impl_->offsetsFor(window.size());
  const bool is_only_layers = impl_->sensors.size() == 1 && impl_->layers.front();
  // The layers of one sensor hold each voxel once: nothing needs to be remembered.
  const bool remembers = impl_->counting == GainCounting::kDistinct && !is_only_layers;
  SeenCells seen(remembers ? window.cellCount() : 0);
  const Eigen::AngleAxisd R_world_base(yaw, Eigen::Vector3d::UnitZ());
  for (std::size_t i = 0; i < impl_->sensors.size(); ++i) {
    const Eigen::Vector3d origin = position + R_world_base * impl_->sensors[i].mount();
    impl_->countSensor(i, window, window.indexOf(origin), yaw, bounds, *offsets,
                       remembers ? &seen : nullptr, tally);
  }
  const bool counts_cones = impl_->counting == GainCounting::kCone;
  tally.gain.unknown_m3 = counts_cones ? tally.cones.value() : tally.gain.unknown_voxels;
  tally.gain.unknown_m3 *= std::pow(impl_->resolution_m, 3);
  return tally.gain;
}

double GainEvaluator::reach() const { return impl_->reach_m; }
double GainEvaluator::reachInHeight() const { return impl_->reach_height_m; }

}  // namespace spelunk::map
