#pragma once

#include <memory>
#include <vector>

#include "scan_marks.h"
#include "spelunk/map/occupancy_map.h"
#include "voxel_key.h"

namespace spelunk::map {

/// Log-odds of the sensor model, rounded to float as OctoMap rounds them.
struct LogOdds {
  explicit LogOdds(const MapParams& params);
  float hit;
  float miss;
  float clamp_min;
  float clamp_max;
  float occupied;  ///< At or above: occupied.
};

/// 8x8x8 voxels: their log-odds and what is asked often as bits.
struct alignas(64) VoxelBlock {
  Mask at_min{};  ///< Clamped: another miss changes nothing.
  Mask at_max{};  ///< Clamped: another hit changes nothing.
  Mask known{};
  Mask occupied{};
  Mask tree_stale{};  ///< Value changed since the OcTree was brought up to date.
  std::array<float, kBlockVoxels> log_odds{};
  PackedKey key = 0;  ///< Of the first voxel.
  bool is_tree_listed = false;
  bool is_status_listed = false;

  [[nodiscard]] Occupancy at(PackedKey voxel) const {
    const auto word = static_cast<std::size_t>(wordOf(voxel));
    const int bit = bitOf(voxel);
    if (((known[word] >> bit) & 1) == 0) return Occupancy::kUnknown;
    return ((occupied[word] >> bit) & 1) != 0 ? Occupancy::kOccupied : Occupancy::kFree;
  }
};

/// All blocks, with counts and lists of what changed. Blocks keep their number for life.
class BlockMap {
 public:
  explicit BlockMap(const LogOdds& log_odds) : log_odds_(log_odds) {}

  /// Enters the marks of one scan; adds what happened to `update`.
  void apply(const ScanMarks& marks, double resolution_m, MapUpdate& update);

  /// Gives a voxel a value, clamped, whatever it was.
  void setValue(PackedKey voxel, float value);

  [[nodiscard]] Occupancy at(const VoxelIndex& index) const;
  [[nodiscard]] const LogOdds& logOdds() const { return log_odds_; }
  [[nodiscard]] std::size_t blockCount() const { return blocks_.size(); }
  [[nodiscard]] const VoxelBlock& block(std::size_t i) const { return *blocks_[i]; }
  [[nodiscard]] std::size_t freeVoxels() const { return free_voxels_; }
  [[nodiscard]] std::size_t occupiedVoxels() const { return occupied_voxels_; }
  [[nodiscard]] const Extent& knownExtent() const { return known_; }
  [[nodiscard]] std::size_t memoryBytes() const;

  /// Numbers of the blocks whose status changed since the last call, in order of change.
  std::vector<std::uint32_t> takeStatusChanges();

  /// Calls `visit(block)` for each block with stale tree values and marks it up to date. Blocks
  /// come in the order of the tree, because neighbours share most of the way down.
  template <class Visit>
  void takeTreeChanges(Visit&& visit) {
    sortAlongTree(tree_changes_);
    for (const std::uint32_t number : tree_changes_) {
      VoxelBlock& changed = *blocks_[number];
      visit(static_cast<const VoxelBlock&>(changed));
      changed.tree_stale = {};
      changed.is_tree_listed = false;
    }
    tree_changes_.clear();
  }

 private:
  std::uint32_t findOrCreate(PackedKey voxel);
  void enter(const ScanMarks::Block& marked, std::uint32_t number, Extent& changed,
             MapUpdate& update);
  /// Adds to the log-odds of some voxels of a plane.
  void vote(VoxelBlock& block, std::size_t z, std::uint64_t voxels, float log_odds);
  void noteTree(std::uint32_t number);
  void sortAlongTree(std::vector<std::uint32_t>& numbers) const;
  void noteStatus(std::uint32_t number, const Mask& known_before, const Mask& occupied_before);

  LogOdds log_odds_;
  std::vector<std::unique_ptr<VoxelBlock>> blocks_;
  KeyTable table_;
  std::vector<std::uint32_t> status_changes_;
  std::vector<std::uint32_t> tree_changes_;
  std::size_t free_voxels_ = 0;
  std::size_t occupied_voxels_ = 0;
  Extent known_{VoxelIndex::Constant(1 << 30), VoxelIndex::Constant(-(1 << 30))};
};

}  // namespace spelunk::map
