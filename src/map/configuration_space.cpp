#include "spelunk/map/configuration_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "inflated_chunk.h"
#include "spelunk/common/contract.h"
#include "voxel_key.h"

namespace spelunk::map {
namespace {

// A face that lies exactly on a border between voxels must not count as touching the next one.
constexpr double kFaceTolerance = 1e-4;    // metres
constexpr std::size_t kChunksKept = 2048;  // 18 MB
constexpr const char* kNoMap = "ConfigurationSpace: no map; call use() first";

/// The voxels a box touches.
struct VoxelBox {
  VoxelIndex first;
  VoxelIndex last;
};

/// One axis of a moving box: when its leading face enters the next voxel and when its trailing
/// face leaves one. Times are shares of the way.
struct AxisMotion {
  int step = 0;
  double lead_time = std::numeric_limits<double>::infinity();
  double trail_time = std::numeric_limits<double>::infinity();
  double period = std::numeric_limits<double>::infinity();

  AxisMotion() = default;
  /// Faces and way in voxels.
  AxisMotion(double low_face, double high_face, double way) {
    if (way == 0.0) return;
    step = way > 0.0 ? 1 : -1;
    period = 1.0 / std::fabs(way);
    const auto timeTo = [&](double face) {
      const double below = voxelOf(face, 1.0);
      return (way > 0.0 ? below + 1.0 - face : face - below) * period;
    };
    lead_time = timeTo(way > 0.0 ? high_face : low_face);
    trail_time = timeTo(way > 0.0 ? low_face : high_face);
  }
};

/// Bits first..last (within 0..7) of a row of eight.
std::uint64_t rowMask(int first, int last) {
  return (0xFFu << first) & (0xFFu >> (kBlockSide - 1 - last)) & 0xFFu;
}

/// The bits of one word of a block, a layer, that lie in the closed box x, y.
std::uint64_t layerMask(const VoxelIndex& first, const VoxelIndex& last) {
  std::uint64_t mask = 0;
  const std::uint64_t row = rowMask(first.x(), last.x());
  for (int y = first.y(); y <= last.y(); ++y) mask |= row << (8 * y);
  return mask;
}

/// Calls `visit(block or nullptr, layer mask, first z, last z)` for the blocks around the voxels of
/// a box in key range until it returns true; whether it did.
template <class Visit>
bool anyBlockOf(const FrozenMap::Blocks& blocks, const VoxelBox& box, Visit&& visit) {
  const auto low = [](int v) { return v & ~(kBlockSide - 1); };
  for (int z = low(box.first.z()); z <= box.last.z(); z += kBlockSide)
    for (int y = low(box.first.y()); y <= box.last.y(); y += kBlockSide)
      for (int x = low(box.first.x()); x <= box.last.x(); x += kBlockSide) {
        const VoxelIndex corner(x, y, z);
        const VoxelIndex first = (box.first - corner).cwiseMax(0);
        const VoxelIndex last = (box.last - corner).cwiseMin(kBlockSide - 1);
        if (visit(blocks.find(packIndex(corner)), layerMask(first, last), first.z(), last.z()))
          return true;
      }
  return false;
}

}  // namespace

struct ConfigurationSpace::Impl {
  /// One chunk as it was when it was last asked for.
  struct Kept {
    PackedKey key = 0;
    std::uint64_t round = 0;  ///< Of the map it was last compared with.
    InflatedChunk::Sources sources;
    std::unique_ptr<const InflatedChunk> chunk;
  };

  Impl(const Eigen::Vector3d& size, Passable may_touch)
      : box_size(size), half(0.5 * size.array() - kFaceTolerance), passable(may_touch) {}

  void use(std::shared_ptr<const FrozenMap> next);
  [[nodiscard]] VoxelBox boxOf(const Eigen::Vector3d& centre) const {
    return {voxelOf(centre - half, inverse_resolution), voxelOf(centre + half, inverse_resolution)};
  }
  [[nodiscard]] bool isFree(const VoxelBox& box);
  [[nodiscard]] bool isFreeVoxelByVoxel(const VoxelBox& box) const;
  [[nodiscard]] Occupancy reasonAt(const VoxelBox& box) const;
  [[nodiscard]] const InflatedChunk& chunkOf(PackedKey key);
  [[nodiscard]] InflatedChunk::Sources sourcesOf(PackedKey key) const;
  void dropUnused();
  template <class Blocked>
  bool walk(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Blocked&& blocked);

  Eigen::Vector3d box_size;
  Eigen::Vector3d half;
  Passable passable;
  std::shared_ptr<const FrozenMap> map;
  double inverse_resolution = 0.0;
  BoxSpan span{};
  std::uint64_t round = 0;
  std::size_t inflations = 0;
  std::vector<Kept> kept;
  KeyTable table;  ///< Chunk key to place in `kept`.
  PackedKey last_key = ~PackedKey{0};
  const InflatedChunk* last_chunk = nullptr;
};

void ConfigurationSpace::Impl::use(std::shared_ptr<const FrozenMap> next) {
  if (next == map) return;
  if (map == nullptr || map->resolution() != next->resolution()) {
    kept.clear();
    table.clear();
  }
  map = std::move(next);
  inverse_resolution = 1.0 / map->resolution();
  span.least = (2.0 * half * inverse_resolution).cast<int>();
  if (kept.size() > kChunksKept) dropUnused();
  ++round;
  last_key = ~PackedKey{0};
}

/// Forgets what was not asked for since the last map.
void ConfigurationSpace::Impl::dropUnused() {
  std::vector<Kept> used;
  for (Kept& each : kept)
    if (each.round == round) used.push_back(std::move(each));
  kept = std::move(used);
  table.clear();
  for (std::size_t i = 0; i < kept.size(); ++i)
    table.insert(kept[i].key, static_cast<std::uint32_t>(i));
}

InflatedChunk::Sources ConfigurationSpace::Impl::sourcesOf(PackedKey key) const {
  InflatedChunk::Sources sources;
  const VoxelIndex corner = unpackIndex(key);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const VoxelIndex place(static_cast<int>(k & 1), static_cast<int>(k >> 1 & 1),
                           static_cast<int>(k >> 2));
    const VoxelIndex at = corner + kChunkSide * place;
    if (!isInKeyRange(at)) continue;
    const std::uint32_t number = map->blocks().table->find(packIndex(at));
    if (number != KeyTable::kAbsent) sources[k] = map->blocks().chunks[number];
  }
  return sources;
}

const InflatedChunk& ConfigurationSpace::Impl::chunkOf(PackedKey key) {
  if (key == last_key) return *last_chunk;
  std::uint32_t place = table.find(key);
  if (place == KeyTable::kAbsent) {
    place = static_cast<std::uint32_t>(kept.size());
    table.insert(key, place);
    kept.push_back({key, 0, {}, nullptr});
  }
  Kept& found = kept[place];
  if (found.round != round) {
    InflatedChunk::Sources sources = sourcesOf(key);
    if (found.chunk == nullptr || found.sources != sources) {
      found.chunk = std::make_unique<const InflatedChunk>(sources, span, passable);
      found.sources = std::move(sources);
      ++inflations;
    }
    found.round = round;
  }
  last_key = key;
  last_chunk = found.chunk.get();
  return *last_chunk;
}

bool ConfigurationSpace::Impl::isFree(const VoxelBox& box) {
  if (!isInKeyRange(box.first) || !isInKeyRange(box.last)) return false;
  const VoxelIndex extra = box.last - box.first - span.least;
  if (!span.fitsChunks() || (extra.array() < 0).any() || (extra.array() > 1).any())
    return isFreeVoxelByVoxel(box);  // a box of whole voxels, and rounding
  const PackedKey key = packIndex(box.first);
  const InflatedChunk& chunk = chunkOf(key & ~kInChunkMask);
  if (chunk.isBlocked()) return false;
  const auto within = [&](int axis) { return box.first(axis) & (kChunkSide - 1); };
  return chunk.isFree({within(0), within(1), within(2)}, extra);
}

bool ConfigurationSpace::Impl::isFreeVoxelByVoxel(const VoxelBox& box) const {
  const bool needs_known = passable == Passable::kKnownFree;
  return !anyBlockOf(
      map->blocks(), box,
      [needs_known](const StatusBlock* block, std::uint64_t mask, int first_z, int last_z) {
        if (block == nullptr) return needs_known;
        for (int z = first_z; z <= last_z; ++z) {
          const auto word = static_cast<std::size_t>(z);
          const std::uint64_t unknown = needs_known ? ~block->known[word] : 0;
          if ((mask & (block->occupied[word] | unknown)) != 0) return true;
        }
        return false;
      });
}

Occupancy ConfigurationSpace::Impl::reasonAt(const VoxelBox& box) const {
  if (!isInKeyRange(box.first) || !isInKeyRange(box.last)) return Occupancy::kUnknown;
  const bool meets_occupied =
      anyBlockOf(map->blocks(), box,
                 [](const StatusBlock* block, std::uint64_t mask, int first_z, int last_z) {
                   if (block == nullptr) return false;
                   for (int z = first_z; z <= last_z; ++z)
                     if ((mask & block->occupied[static_cast<std::size_t>(z)]) != 0) return true;
                   return false;
                 });
  return meets_occupied ? Occupancy::kOccupied : Occupancy::kUnknown;
}

/// Looks at the box at `a`, whenever it enters a new layer of voxels on an axis, and at `b`: in
/// between the box only leaves voxels, so these boxes cover everything the sweep touches. A voxel
/// left in the very moment another is entered still counts.
template <class Blocked>
bool ConfigurationSpace::Impl::walk(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    Blocked&& blocked) {
  require(map != nullptr, kNoMap);
  VoxelBox box = boxOf(a);
  if (!isFree(box)) return blocked(box);
  if (a == b) return true;
  std::array<AxisMotion, 3> motion;
  for (int i = 0; i < 3; ++i)
    motion[static_cast<std::size_t>(i)] = {(a(i) - half(i)) * inverse_resolution,
                                           (a(i) + half(i)) * inverse_resolution,
                                           (b(i) - a(i)) * inverse_resolution};
  for (;;) {
    int axis = motion[0].lead_time <= motion[1].lead_time ? 0 : 1;
    if (motion[2].lead_time < motion[static_cast<std::size_t>(axis)].lead_time) axis = 2;
    AxisMotion& leading = motion[static_cast<std::size_t>(axis)];
    const double time = leading.lead_time;
    if (!(time <= 1.0)) break;
    for (int i = 0; i < 3; ++i) {
      AxisMotion& trailing = motion[static_cast<std::size_t>(i)];
      for (; trailing.trail_time < time; trailing.trail_time += trailing.period)
        (trailing.step > 0 ? box.first : box.last)(i) += trailing.step;
    }
    (leading.step > 0 ? box.last : box.first)(axis) += leading.step;
    leading.lead_time += leading.period;
    if (!isFree(box)) return blocked(box);
  }
  const VoxelBox end = boxOf(b);
  return isFree(end) || blocked(end);
}

ConfigurationSpace::ConfigurationSpace(const Eigen::Vector3d& box_size, Passable passable) {
  require(box_size.allFinite() && (box_size.array() > 2.0 * kFaceTolerance).all(),
          "ConfigurationSpace: the box must have a positive size");
  impl_ = std::make_unique<Impl>(box_size, passable);
}
ConfigurationSpace::ConfigurationSpace(const Eigen::Vector3d& box_size,
                                       std::shared_ptr<const FrozenMap> map, Passable passable)
    : ConfigurationSpace(box_size, passable) {
  use(std::move(map));
}
ConfigurationSpace::~ConfigurationSpace() = default;
ConfigurationSpace::ConfigurationSpace(ConfigurationSpace&&) noexcept = default;
ConfigurationSpace& ConfigurationSpace::operator=(ConfigurationSpace&&) noexcept = default;

void ConfigurationSpace::use(std::shared_ptr<const FrozenMap> map) {
  require(map != nullptr, "ConfigurationSpace: no map");
  require((impl_->box_size.array() < 1e6 * map->resolution()).all(),
          "ConfigurationSpace: box too large");
  impl_->use(std::move(map));
}

bool ConfigurationSpace::isFree(const Eigen::Vector3d& centre) {
  return isSweepFree(centre, centre);
}

Occupancy ConfigurationSpace::boxAt(const Eigen::Vector3d& centre) { return sweep(centre, centre); }

bool ConfigurationSpace::isSweepFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return impl_->walk(a, b, [](const VoxelBox&) { return false; });
}

Occupancy ConfigurationSpace::sweep(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Occupancy answer = Occupancy::kFree;
  impl_->walk(a, b, [&](const VoxelBox& box) {
    answer = impl_->reasonAt(box);
    return false;
  });
  return answer;
}

const Eigen::Vector3d& ConfigurationSpace::boxSize() const { return impl_->box_size; }

Passable ConfigurationSpace::passable() const { return impl_->passable; }

double ConfigurationSpace::resolution() const {
  require(impl_->map != nullptr, kNoMap);
  return impl_->map->resolution();
}

std::size_t ConfigurationSpace::inflations() const { return impl_->inflations; }

}  // namespace spelunk::map
