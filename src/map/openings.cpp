#include "spelunk/map/openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "frozen_blocks.h"

namespace spelunk::map {
namespace {

const std::array<VoxelIndex, 6> kNeighbours{VoxelIndex(1, 0, 0), VoxelIndex(-1, 0, 0),
                                            VoxelIndex(0, 1, 0), VoxelIndex(0, -1, 0),
                                            VoxelIndex(0, 0, 1), VoxelIndex(0, 0, -1)};

/// A part of the border between free and silent voxels.
struct Border {
  VoxelIndex normal = VoxelIndex::Zero();  ///< Sum over its faces, out of the free space.
  Eigen::Vector3d centres = Eigen::Vector3d::Zero();  ///< Sum over its faces, in voxels.
  int faces = 0;

  [[nodiscard]] Eigen::Vector3d centre() const { return centres / faces; }
  void add(const Border& other) {
    normal += other.normal;
    centres += other.centres;
    faces += other.faces;
  }
};

/// The faces of a silent voxel that border on free ones.
Border borderOf(const FrozenMap& map, const VoxelIndex& silent) {
  Border border;
  for (const VoxelIndex& step : kNeighbours) {
    if (map.at(VoxelIndex(silent + step)) != Occupancy::kFree) continue;
    border.normal -= step;
    border.centres += silent.cast<double>() + 0.5 * step.cast<double>();
    ++border.faces;
  }
  return border;
}

template <class Visit>
void forEachSilent(const FrozenMap& map, Visit&& visit) {
  for (const auto& chunk : map.blocks().chunks)
    for (int slot = 0; slot < 64; ++slot) {
      const VoxelIndex corner =
          unpackIndex(chunk->key) + kBlockSide * VoxelIndex(slot & 3, (slot >> 2) & 3, slot >> 4);
      forEachVoxel(chunk->blocks[static_cast<std::size_t>(slot)].silent,
                   [&](const VoxelIndex& in_block) { visit(VoxelIndex(corner + in_block)); });
    }
}

/// Borders by cell of a coarse grid, in a fixed order.
using Cells = std::map<std::array<int, 3>, Border>;

Cells bordersByCell(const FrozenMap& map, int cell_side) {
  Cells cells;
  forEachSilent(map, [&](const VoxelIndex& voxel) {
    const Border border = borderOf(map, voxel);
    if (border.faces == 0) return;
    std::array<int, 3> cell;
    for (int i = 0; i < 3; ++i)
      cell[static_cast<std::size_t>(i)] =
          static_cast<int>(std::floor(static_cast<double>(voxel(i)) / cell_side));
    cells[cell].add(border);
  });
  return cells;
}

/// Takes a cell and all that are joined to it by neighbours out of `cells`.
std::vector<Border> takeConnected(Cells& cells) {
  std::vector<Border> parts;
  std::vector<Cells::node_type> open;
  open.push_back(cells.extract(cells.begin()));
  while (!open.empty()) {
    const Cells::node_type node = std::move(open.back());
    open.pop_back();
    parts.push_back(node.mapped());
    for (int k = 0; k < 27; ++k) {
      const auto& [x, y, z] = node.key();
      auto next = cells.extract({x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1});
      if (!next.empty()) open.push_back(std::move(next));
    }
  }
  return parts;
}

/// Known space ends in a bulge before an opening, for no ray comes back through its middle: the
/// place is moved out to where the border is outermost, beside the rock.
Opening openingOf(const std::vector<Border>& parts, double resolution_m) {
  Border sum;
  for (const Border& part : parts) sum.add(part);
  Opening opening;
  const Eigen::Vector3d normal = sum.normal.cast<double>();
  opening.area_m2 = normal.norm() * resolution_m * resolution_m;
  if (opening.area_m2 > 0.0) opening.outward = normal.normalized();
  double outermost = 0.0;
  for (const Border& part : parts)
    outermost = std::max(outermost, (part.centre() - sum.centre()).dot(opening.outward));
  const Eigen::Vector3d place = sum.centre() + outermost * opening.outward;
  opening.centre = (place.array() + 0.5) * resolution_m;
  return opening;
}

}  // namespace

std::vector<Opening> findOpenings(const FrozenMap& map, const Eigen::Vector3d& box) {
  const double width_m = std::min(box.x(), box.y());
  const double resolution_m = map.resolution();
  Cells cells =
      bordersByCell(map, std::max(1, static_cast<int>(std::lround(0.5 * width_m / resolution_m))));
  std::vector<Opening> openings;
  while (!cells.empty()) {
    const Opening opening = openingOf(takeConnected(cells), resolution_m);
    if (opening.area_m2 >= width_m * box.z()) openings.push_back(opening);
  }
  std::stable_sort(openings.begin(), openings.end(),
                   [](const Opening& a, const Opening& b) { return a.area_m2 > b.area_m2; });
  return openings;
}

}  // namespace spelunk::map
