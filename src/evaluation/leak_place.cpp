#include "leak_place.h"

#include <array>
#include <deque>
#include <vector>

#include "enclosure.h"
#include "spelunk/common/contract.h"

namespace spelunk::evaluation {
namespace {

/// One bit a voxel and question: together the step that led to a voxel.
class Steps {
 public:
  explicit Steps(const VoxelGrid& like) : bits_{like, like, like} {
    for (VoxelGrid& grid : bits_) grid.forEachSet([&grid](std::size_t k) { grid.clear(k); });
  }
  /// `step` is 1 to 7.
  void note(std::size_t offset, unsigned step) {
    for (unsigned k = 0; k < 3; ++k)
      if ((step >> k & 1U) != 0) bits_[k].set(offset);
  }
  /// 0 if none was noted.
  [[nodiscard]] unsigned at(std::size_t offset) const {
    unsigned step = 0;
    for (unsigned k = 0; k < 3; ++k) step |= bits_[k].isSet(offset) ? 1U << k : 0U;
    return step;
  }

 private:
  std::array<VoxelGrid, 3> bits_;
};

/// Steps 1 to 6 are down and up along the axes; the start is marked with 7.
constexpr unsigned kStart = 7;
Eigen::Vector3i offsetOf(unsigned step) {
  const int axis = static_cast<int>(step - 1) / 2;
  return (step - 1) % 2 == 0 ? Eigen::Vector3i(-Eigen::Vector3i::Unit(axis))
                             : Eigen::Vector3i(Eigen::Vector3i::Unit(axis));
}

bool isClear(const MeshVoxels& voxels, const Eigen::Vector3i& from, unsigned step) {
  const int axis = static_cast<int>(step - 1) / 2;
  const Eigen::Vector3i lower = from.cwiseMin(from + offsetOf(step));
  return voxels.joins(voxels.grid().offsetOf(lower), axis);
}

/// The voxels of a shortest way from the start to the first one outside the bounds, backwards.
std::vector<Eigen::Vector3i> wayOut(const MeshVoxels& voxels, const Eigen::Vector3i& start) {
  const VoxelGrid& grid = voxels.grid();
  Steps steps(grid);
  std::deque<Eigen::Vector3i> open{start};
  steps.note(grid.offsetOf(start), kStart);
  const auto back = [&](Eigen::Vector3i cell) {
    std::vector<Eigen::Vector3i> way{cell};
    for (unsigned step = 0; (step = steps.at(grid.offsetOf(cell))) != kStart;) {
      cell -= offsetOf(step);
      way.push_back(cell);
    }
    return way;
  };
  for (; !open.empty(); open.pop_front()) {
    const Eigen::Vector3i cell = open.front();
    for (unsigned step = 1; step <= 6; ++step) {
      const Eigen::Vector3i next = cell + offsetOf(step);
      const std::size_t offset = grid.offsetOf(next);
      if (steps.at(offset) != 0 || !isClear(voxels, cell, step)) continue;
      steps.note(offset, step);
      if (!voxels.isWithin(next)) return back(next);
      open.push_back(next);
    }
  }
  throw Precondition("findLeak: the space does not leak");
}

}  // namespace

Leak findLeak(const sim::WorldMesh& mesh, const MeshVoxels& voxels, const Eigen::Vector3i& start) {
  const std::vector<Eigen::Vector3i> way = wayOut(voxels, start);
  const auto placeOf = [&](std::size_t k) { return voxels.grid().centreOf(way[k]); };
  const auto isInside = [&](std::size_t k) { return isSurrounded(mesh, placeOf(k)); };
  std::size_t inside = way.size() - 1;
  std::size_t outside = 0;
  const Eigen::Vector3d exit = 0.5 * (placeOf(0) + placeOf(1));
  if (!isInside(inside)) return {exit, false};
  if (isInside(outside)) return {exit, true};
  while (inside - outside > 1) {
    const std::size_t middle = (inside + outside) / 2;
    (isInside(middle) ? inside : outside) = middle;
  }
  return {0.5 * (placeOf(inside) + placeOf(outside)), true};
}

}  // namespace spelunk::evaluation
