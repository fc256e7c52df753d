#include "spelunk/evaluation/reachable_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "enclosure.h"
#include "leak_place.h"
#include "mesh_voxels.h"
#include "spelunk/common/contract.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/start_check.h"

namespace spelunk::evaluation {
namespace {

/// Fills the free voxels within the bounds that are joined to a start.
class Flood {
 public:
  Flood(const MeshVoxels& voxels, VoxelGrid& free) : voxels_(voxels), free_(free) {}

  void fillFrom(const Eigen::Vector3i& start) {
    visit(start, free_.offsetOf(start));
    while (!open_.empty()) {
      const std::size_t offset = open_.back();
      open_.pop_back();
      spread(free_.cellAt(offset), offset);
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] bool leaks() const { return leaks_; }

 private:
  void spread(const Eigen::Vector3i& cell, std::size_t offset) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
      const std::size_t stride = free_.offsetOf(step);
      if (voxels_.joins(offset, axis)) visit(cell + step, offset + stride);
      if (voxels_.joins(offset - stride, axis)) visit(cell - step, offset - stride);
    }
  }

  void visit(const Eigen::Vector3i& cell, std::size_t offset) {
    if (!voxels_.isWithin(cell)) {
      leaks_ = true;
      return;
    }
    if (!free_.set(offset)) return;
    ++count_;
    open_.push_back(offset);
  }

  const MeshVoxels& voxels_;
  VoxelGrid& free_;
  std::vector<std::size_t> open_;
  std::size_t count_ = 0;
  bool leaks_ = false;
};

bool touches(const VoxelGrid& reached, const Eigen::Vector3i& cell) {
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Eigen::Vector3i neighbour = cell + Eigen::Vector3i(x, y, z);
        if (reached.contains(neighbour) && reached.isSet(reached.offsetOf(neighbour))) return true;
      }
  return false;
}

/// Of the surface only what touches free voxels and is not free itself.
void keepTouched(ReachableSpace& space) {
  space.surface.forEachSet([&](std::size_t offset) {
    if (!space.free.isSet(offset) && touches(space.free, space.surface.cellAt(offset)))
      ++space.surface_voxels;
    else
      space.surface.clear(offset);
  });
}

/// The voxel of the start; else, where a triangle runs through that one too, the nearest of those
/// around it whose centre can be seen from the start.
Eigen::Vector3i freeVoxelAt(const sim::WorldMesh& mesh, const MeshVoxels& voxels,
                            const Eigen::Vector3d& start) {
  const VoxelGrid& grid = voxels.grid();
  const Eigen::Vector3i own = grid.cellOf(start);
  if (!voxels.isWithin(own))
    throw OutsideError("the start " + sim::textOf(start, mesh) + " lies outside the mesh '" +
                       mesh.name + "': choose one inside with --start x,y,z,yaw");
  if (!voxels.isMet(grid.offsetOf(own))) return own;
  std::vector<std::pair<double, std::size_t>> around;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Eigen::Vector3i cell = own + Eigen::Vector3i(x, y, z);
        if (voxels.isWithin(cell) && !voxels.isMet(grid.offsetOf(cell)))
          around.emplace_back((grid.centreOf(cell) - start).norm(), grid.offsetOf(cell));
      }
  std::sort(around.begin(), around.end());
  const sim::MeshScene scene(mesh);
  for (const auto& [gap, offset] : around) {
    const Eigen::Vector3i cell = grid.cellAt(offset);
    if (!scene.castRay(start, (grid.centreOf(cell) - start) / gap, gap)) return cell;
  }
  throw OutsideError("the start " + sim::textOf(start, mesh) +
                     " lies in the surface of the mesh '" + mesh.name +
                     "': choose one in free space with --start x,y,z,yaw");
}

}  // namespace

ReachableSpace reachableSpace(const sim::WorldMesh& mesh, const Eigen::Vector3d& start,
                              double resolution_m) {
  MeshVoxels voxels(mesh, resolution_m);
  const Eigen::Vector3i first = freeVoxelAt(mesh, voxels, start);
  VoxelGrid free(mesh.bounds(), resolution_m);
  Flood flood(voxels, free);
  flood.fillFrom(first);
  std::optional<Leak> leak;
  if (flood.leaks()) leak = findLeak(mesh, voxels, first);
  ReachableSpace space{
      std::move(free),        std::move(voxels).takeSurface(), flood.count(), 0, leak,
      isEnclosed(mesh, start)};
  keepTouched(space);
  return space;
}

ReachableVolume volumeOf(const ReachableSpace& space) {
  const double voxel_m3 = std::pow(space.free.resolution(), 3);
  return {static_cast<double>(space.free_voxels) * voxel_m3,
          static_cast<double>(space.surface_voxels) * voxel_m3,
          static_cast<double>(space.free_voxels + space.surface_voxels) * voxel_m3, space.leak};
}

ReachableVolume reachableVolume(const sim::WorldMesh& mesh, const Eigen::Vector3d& start,
                                double resolution_m) {
  return volumeOf(reachableSpace(mesh, start, resolution_m));
}

std::string textOf(const Leak& leak, const std::string& mesh_name) {
  const std::string head = "the mesh '" + mesh_name + "' leaks";
  const std::string tail =
      "; reachable_volume_m3 holds what can be reached as far as the bounds of the mesh";
  if (!leak.is_start_inside)
    return head +
           ": its triangles do not surround the start and face one way; the free space "
           "around the start leaves the bounds of the mesh at " +
           sim::textOf(leak.place) + tail;
  return head + " at " + sim::textOf(leak.place) +
         ": the free space around the start is open to the outside there. If that is no portal, "
         "close the hole" +
         tail;
}

}  // namespace spelunk::evaluation
