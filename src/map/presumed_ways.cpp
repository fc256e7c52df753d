#include "spelunk/map/presumed_ways.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "frozen_blocks.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr int kCellSide = 4;    // voxels
constexpr int kCellsASide = 8;  // of a chunk
constexpr std::size_t kCells = kCellsASide * kCellsASide * kCellsASide;
constexpr int kFreeEnough = 16;  // of the 64 voxels of a cell
constexpr float kUnreached = std::numeric_limits<float>::infinity();
constexpr std::uint8_t kNoStep = 255;

/// A cell is named by its first voxel.
PackedKey cellOf(PackedKey voxel) { return voxel & ~(3 * kFieldOnes); }

std::size_t slotOf(PackedKey cell) {
  return static_cast<std::size_t>(((cell >> 2) & 7) | ((cell >> (kKeyFieldBits - 1)) & 56) |
                                  ((cell >> (2 * kKeyFieldBits - 4)) & 448));
}

/// One of the 26 steps to a neighbour.
struct Step {
  PackedKey shift;  ///< Added to the key: fields wrap over, and keys lie far from their ends.
  float cells;      ///< Its length.
};

std::array<Step, 26> makeSteps() {
  std::array<Step, 26> steps{};
  std::size_t next = 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        const auto field = [](int step, int axis) {
          return static_cast<PackedKey>(static_cast<std::int64_t>(kCellSide * step) *
                                        (std::int64_t{1} << (axis * kKeyFieldBits)));
        };
        steps[next++] = {field(x, 0) + field(y, 1) + field(z, 2),
                         std::sqrt(static_cast<float>(x * x + y * y + z * z))};
      }
  return steps;
}

const std::array<Step, 26>& steps() {
  static const std::array<Step, 26> all = makeSteps();
  return all;
}

/// What is known of the ways through one chunk.
struct Field {
  std::array<float, kCells> length;       ///< In cells; negative: not passable.
  std::array<std::uint8_t, kCells> step;  ///< By which the cell was reached.
};

/// Free voxels of the cell at (x, y, z) of a block, each 0 or 1.
int freeIn(const StatusBlock& block, int x, int y, int z) {
  const std::uint64_t half_rows = 0x0F0F0F0FULL << (kCellSide * x + 32 * y);
  int count = 0;
  for (int k = kCellSide * z; k < kCellSide * (z + 1); ++k) {
    const auto word = static_cast<std::size_t>(k);
    count += __builtin_popcountll(block.known[word] & ~block.occupied[word] & half_rows);
  }
  return count;
}

Field fieldOf(const StatusChunk& chunk) {
  Field field;
  field.step.fill(kNoStep);
  for (int z = 0; z < kCellsASide; ++z)
    for (int y = 0; y < kCellsASide; ++y)
      for (int x = 0; x < kCellsASide; ++x) {
        const auto block = static_cast<std::size_t>((x / 2) + 4 * (y / 2) + 16 * (z / 2));
        const bool is_open = freeIn(chunk.blocks[block], x & 1, y & 1, z & 1) >= kFreeEnough;
        field.length[static_cast<std::size_t>(x + kCellsASide * (y + kCellsASide * z))] =
            is_open ? kUnreached : -1.0F;
      }
  return field;
}

}  // namespace

struct PresumedWays::Impl {
  std::shared_ptr<const FrozenMap> map;
  double cell_m;
  std::vector<std::unique_ptr<Field>> fields;  ///< By the number of the chunk; made when entered.
  PackedKey last_chunk = ~PackedKey{0};        ///< Entered last: neighbours mostly share it.
  Field* last_field = nullptr;

  /// Reached next, nearest first; among equals the lower key, so that ways repeat.
  using Entry = std::pair<float, PackedKey>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open{};

  Impl(std::shared_ptr<const FrozenMap> given, const std::vector<ClosedPlace>& closed)
      : map(std::move(given)), cell_m(kCellSide * map->resolution()) {
    fields.resize(map->blocks().chunks.size());
    for (const ClosedPlace& place : closed) close(place);
  }

  [[nodiscard]] Eigen::Vector3d centreOf(PackedKey cell) const {
    return (unpackIndex(cell).cast<double>().array() + 0.5 * kCellSide) * map->resolution();
  }

  [[nodiscard]] PackedKey cellAt(const Eigen::Vector3d& point) const {
    return cellOf(packIndex(map->indexOf(point)));
  }

  /// The field around a cell; none where nothing was ever seen.
  Field* enter(PackedKey cell) {
    const PackedKey chunk = cell & ~kInChunkMask;
    if (chunk != last_chunk) {
      last_chunk = chunk;
      last_field = fieldAround(chunk);
    }
    return last_field;
  }

  Field* fieldAround(PackedKey chunk) {
    const std::uint32_t number = map->blocks().table->find(chunk);
    if (number == KeyTable::kAbsent) return nullptr;
    if (!fields[number])
      fields[number] = std::make_unique<Field>(fieldOf(*map->blocks().chunks[number]));
    return fields[number].get();
  }

  void close(const ClosedPlace& place) {
    const int reach = static_cast<int>(std::ceil(place.radius_m / cell_m)) + 1;
    for (int z = -reach; z <= reach; ++z)
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
          const PackedKey cell = cellAt(place.centre + cell_m * Eigen::Vector3d(x, y, z));
          if ((centreOf(cell) - place.centre).norm() > place.radius_m) continue;
          if (Field* field = enter(cell)) field->length[slotOf(cell)] = -1.0F;
        }
  }

  void reach(PackedKey cell, float length, std::uint8_t step) {
    Field* field = enter(cell);
    if (field == nullptr) return;
    const std::size_t slot = slotOf(cell);
    if (field->length[slot] <= length) return;
    field->length[slot] = length;
    field->step[slot] = step;
    open.emplace(length, cell);
  }

  void spread(PackedKey from, float longest) {
    if (Field* field = enter(from)) field->length[slotOf(from)] = kUnreached;  // the robot is there
    reach(from, 0.0F, kNoStep);
    while (!open.empty()) {
      const auto [length, cell] = open.top();
      open.pop();
      if (length > enter(cell)->length[slotOf(cell)]) continue;
      for (std::size_t k = 0; k < steps().size(); ++k) {
        const float further = length + steps()[k].cells;
        if (further <= longest)
          reach(cell + steps()[k].shift, further, static_cast<std::uint8_t>(k));
      }
    }
  }

  /// Length in cells; infinite if the cell was not reached.
  [[nodiscard]] float lengthTo(PackedKey cell) const {
    const std::uint32_t number = map->blocks().table->find(cell & ~kInChunkMask);
    if (number == KeyTable::kAbsent || !fields[number]) return kUnreached;
    const float length = fields[number]->length[slotOf(cell)];
    return length < 0.0F ? kUnreached : length;
  }

  /// The cell at a point or, if that was not reached, the one beside it that was reached first.
  [[nodiscard]] PackedKey nearestTo(const Eigen::Vector3d& point) const {
    PackedKey best = cellAt(point);
    if (std::isfinite(lengthTo(best))) return best;
    const PackedKey at = best;
    for (const Step& step : steps())
      if (lengthTo(at + step.shift) < lengthTo(best)) best = at + step.shift;
    return best;
  }

  [[nodiscard]] std::uint8_t stepInto(PackedKey cell) const {
    return fields[map->blocks().table->find(cell & ~kInChunkMask)]->step[slotOf(cell)];
  }
};

PresumedWays::PresumedWays(std::shared_ptr<const FrozenMap> map, const Eigen::Vector3d& from,
                           double reach_m, const std::vector<ClosedPlace>& closed) {
  require(map != nullptr, "PresumedWays: no map");
  require(from.allFinite() && isInKeyRange(map->indexOf(from)), "PresumedWays: bad start");
  impl_ = std::make_unique<Impl>(std::move(map), closed);
  impl_->spread(impl_->cellAt(from), static_cast<float>(reach_m / impl_->cell_m));
}
PresumedWays::~PresumedWays() = default;
PresumedWays::PresumedWays(PresumedWays&&) noexcept = default;
PresumedWays& PresumedWays::operator=(PresumedWays&&) noexcept = default;

double PresumedWays::distanceTo(const Eigen::Vector3d& point) const {
  if (!isInKeyRange(impl_->map->indexOf(point))) return std::numeric_limits<double>::infinity();
  return impl_->cell_m * static_cast<double>(impl_->lengthTo(impl_->nearestTo(point)));
}

std::vector<Eigen::Vector3d> PresumedWays::wayTo(const Eigen::Vector3d& point) const {
  if (!std::isfinite(distanceTo(point))) return {};
  std::vector<Eigen::Vector3d> way;
  PackedKey cell = impl_->nearestTo(point);
  for (;;) {
    way.push_back(impl_->centreOf(cell));
    const std::uint8_t step = impl_->stepInto(cell);
    if (step == kNoStep) break;
    cell -= steps()[step].shift;
  }
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace spelunk::map
