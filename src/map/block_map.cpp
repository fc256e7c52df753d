#include "block_map.h"

#include <octomap/octomap_utils.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

template <class Visit>
void forEachBit(std::uint64_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(__builtin_ctzll(bits));
}

AxisAlignedBox emptyBox() {
  return {Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()),
          Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity())};
}

void grow(Extent& extent, const Extent& other) {
  extent.min = extent.min.cwiseMin(other.min);
  extent.max = extent.max.cwiseMax(other.max);
}

Extent extentIn(const VoxelBlock& block, const Mask& mask) {
  const VoxelIndex first = unpackIndex(block.key);
  const Extent local = extentOf(mask);
  return {first + local.min, first + local.max};
}

void addVoxels(const VoxelBlock& block, const Mask& mask, std::vector<VoxelIndex>& voxels) {
  const VoxelIndex first = unpackIndex(block.key);
  for (std::size_t z = 0; z < mask.size(); ++z)
    forEachBit(mask[z], [&](int bit) {
      voxels.push_back(first + VoxelIndex(bit & 7, bit >> 3, static_cast<int>(z)));
    });
}

bool isEmpty(const Mask& mask) {
  return std::all_of(mask.begin(), mask.end(), [](std::uint64_t word) { return word == 0; });
}

int countOf(const Mask& mask) {
  int count = 0;
  for (const std::uint64_t word : mask) count += __builtin_popcountll(word);
  return count;
}

}  // namespace

LogOdds::LogOdds(const MapParams& params)
    : hit(octomap::logodds(params.hit_probability)),
      miss(octomap::logodds(params.miss_probability)),
      clamp_min(octomap::logodds(params.clamp_min_probability)),
      clamp_max(octomap::logodds(params.clamp_max_probability)),
      occupied(octomap::logodds(params.occupied_probability)) {
  require(std::isfinite(clamp_min) && std::isfinite(clamp_max) && clamp_min < clamp_max,
          "map: clamping probabilities must lie strictly between 0 and 1, the smaller one first");
}

std::uint32_t BlockMap::findOrCreate(PackedKey voxel) {
  const PackedKey key = voxel & ~kInBlockMask;
  const std::uint32_t found = table_.find(key);
  if (found != KeyTable::kAbsent) return found;
  const auto number = static_cast<std::uint32_t>(blocks_.size());
  table_.insert(key, number);
  blocks_.push_back(std::make_unique<VoxelBlock>());
  blocks_.back()->key = key;
  return number;
}

void BlockMap::vote(VoxelBlock& block, std::size_t z, std::uint64_t voxels, float log_odds) {
  float* values = block.log_odds.data() + z * 64;
  std::uint64_t occupied = 0;
  std::uint64_t at_min = 0;
  std::uint64_t at_max = 0;
  forEachBit(voxels, [&](int bit) {
    const float value =
        std::min(std::max(values[bit] + log_odds, log_odds_.clamp_min), log_odds_.clamp_max);
    values[bit] = value;
    occupied |= std::uint64_t{value >= log_odds_.occupied} << bit;
    at_min |= std::uint64_t{value <= log_odds_.clamp_min} << bit;
    at_max |= std::uint64_t{value >= log_odds_.clamp_max} << bit;
  });
  block.occupied[z] = (block.occupied[z] & ~voxels) | occupied;
  block.at_min[z] = (block.at_min[z] & ~voxels) | at_min;
  block.at_max[z] = (block.at_max[z] & ~voxels) | at_max;
  block.known[z] |= voxels;
  block.tree_stale[z] |= voxels;
}

void BlockMap::enter(const ScanMarks::Block& marked, std::uint32_t number, Extent& changed,
                     MapUpdate& update) {
  VoxelBlock& block = *blocks_[number];
  Mask hit;
  Mask free;
  std::uint64_t open = 0;  // what another vote can change
  for (std::size_t z = 0; z < kBlockSide; ++z) {
    update.voxels_updated += __builtin_popcountll(marked.hit[z] | marked.free[z]);
    hit[z] = marked.hit[z] & ~block.at_max[z];
    free[z] = marked.free[z] & ~marked.hit[z] & ~block.at_min[z];  // occupied wins within a scan
    open |= hit[z] | free[z];
  }
  if (open == 0) return;
  const Mask known_before = block.known;
  const Mask occupied_before = block.occupied;
  for (std::size_t z = 0; z < kBlockSide; ++z) {
    if (free[z] != 0) vote(block, z, free[z], log_odds_.miss);
    if (hit[z] != 0) vote(block, z, hit[z], log_odds_.hit);
  }
  noteTree(number);
  Mask differs;
  Mask newly_occupied;
  for (std::size_t z = 0; z < kBlockSide; ++z) {
    newly_occupied[z] = block.occupied[z] & ~occupied_before[z];
    differs[z] = (block.known[z] ^ known_before[z]) | (block.occupied[z] ^ occupied_before[z]);
  }
  if (isEmpty(differs)) return;
  noteStatus(number, known_before, occupied_before);
  update.voxels_changed_status += countOf(differs);
  addVoxels(block, newly_occupied, update.newly_occupied);
  grow(changed, extentIn(block, differs));
}

void BlockMap::apply(const ScanMarks& marks, double resolution_m, MapUpdate& update) {
  Extent changed{VoxelIndex::Constant(1 << 30), VoxelIndex::Constant(-(1 << 30))};
  constexpr std::size_t kAhead = 16;  // blocks asked from memory before the first is read
  std::array<std::uint32_t, kAhead> numbers;
  const std::vector<ScanMarks::Block>& marked = marks.blocks();
  for (std::size_t first = 0; first < marked.size(); first += kAhead) {
    const std::size_t count = std::min(kAhead, marked.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      numbers[i] = findOrCreate(marked[first + i].key);
      __builtin_prefetch(&blocks_[numbers[i]]->at_min);
      __builtin_prefetch(&blocks_[numbers[i]]->at_max);
    }
    for (std::size_t i = 0; i < count; ++i) enter(marked[first + i], numbers[i], changed, update);
  }
  update.changed = emptyBox();
  if ((changed.min.array() > changed.max.array()).any()) return;
  update.changed.min = changed.min.cast<double>() * resolution_m;
  update.changed.max = (changed.max.array() + 1).cast<double>() * resolution_m;
}

void BlockMap::setValue(PackedKey voxel, float value) {
  const std::uint32_t number = findOrCreate(voxel);
  VoxelBlock& block = *blocks_[number];
  const Mask known_before = block.known;
  const Mask occupied_before = block.occupied;
  const auto z = static_cast<std::size_t>(wordOf(voxel));
  const int bit = bitOf(voxel);
  block.log_odds[z * 64 + static_cast<std::size_t>(bit)] = 0.0F;
  vote(block, z, std::uint64_t{1} << bit, value);
  noteTree(number);
  if (block.known != known_before || block.occupied != occupied_before)
    noteStatus(number, known_before, occupied_before);
}

void BlockMap::noteTree(std::uint32_t number) {
  if (blocks_[number]->is_tree_listed) return;
  blocks_[number]->is_tree_listed = true;
  tree_changes_.push_back(number);
}

void BlockMap::sortAlongTree(std::vector<std::uint32_t>& numbers) const {
  const auto spread = [](PackedKey key) {  // bits of the three axes interleaved
    std::uint64_t code = 0;
    for (int bit = 15; bit >= 3; --bit)
      for (int axis = 2; axis >= 0; --axis)
        code = code << 1 | ((key >> (axis * kKeyFieldBits + bit)) & 1);
    return code;
  };
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(numbers.size());
  for (const std::uint32_t number : numbers)
    order.emplace_back(spread(blocks_[number]->key), number);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = order[i].second;
}

void BlockMap::noteStatus(std::uint32_t number, const Mask& known_before,
                          const Mask& occupied_before) {
  VoxelBlock& block = *blocks_[number];
  const auto occupied_count = static_cast<std::size_t>(countOf(block.occupied));
  const auto occupied_count_before = static_cast<std::size_t>(countOf(occupied_before));
  occupied_voxels_ += occupied_count - occupied_count_before;
  free_voxels_ += static_cast<std::size_t>(countOf(block.known)) - occupied_count -
                  (static_cast<std::size_t>(countOf(known_before)) - occupied_count_before);
  if (block.known != known_before) grow(known_, extentIn(block, block.known));
  if (block.is_status_listed) return;
  block.is_status_listed = true;
  status_changes_.push_back(number);
}

Occupancy BlockMap::at(const VoxelIndex& index) const {
  if (!isInKeyRange(index)) return Occupancy::kUnknown;
  const PackedKey key = packIndex(index);
  const std::uint32_t number = table_.find(key & ~kInBlockMask);
  return number == KeyTable::kAbsent ? Occupancy::kUnknown : blocks_[number]->at(key);
}

std::vector<std::uint32_t> BlockMap::takeStatusChanges() {
  for (const std::uint32_t number : status_changes_) blocks_[number]->is_status_listed = false;
  return std::exchange(status_changes_, {});
}

std::size_t BlockMap::memoryBytes() const {
  return blocks_.size() * (sizeof(VoxelBlock) + sizeof(void*)) + table_.memoryBytes();
}

}  // namespace spelunk::map
