#include "spelunk/evaluation/plan_view.h"

#include <algorithm>
#include <fstream>

#include "spelunk/common/contract.h"
#include "spelunk/common/params.h"
#include "spelunk/map/local_window.h"

namespace spelunk::evaluation {
namespace {

constexpr int kSlabRows = 16;  ///< Rows that are copied out of the map at once.
constexpr std::uint8_t kNone = 255;

void countUp(std::uint8_t& count) { count = static_cast<std::uint8_t>(std::min(254, count + 1)); }

/// Enters the window's rows from `first_row` of the view on.
void addSlab(const map::LocalWindow& window, const map::VoxelIndex& first, int first_row,
             int last_row, int layers, PlanView& view) {
  for (int layer = 0; layer < layers; ++layer) {
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = 0; column < view.width; ++column) {
        const auto status = window.at(map::VoxelIndex(first + map::VoxelIndex(column, row, layer)));
        if (status == map::Occupancy::kUnknown) continue;
        const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(view.width) +
                          static_cast<std::size_t>(column);
        countUp(status == map::Occupancy::kFree ? view.free[cell] : view.occupied[cell]);
        if (status == map::Occupancy::kFree && view.floor[cell] == kNone)
          view.floor[cell] = static_cast<std::uint8_t>(std::min(254, layer));
      }
    }
  }
}

void writeLayer(std::ofstream& file, const std::vector<std::uint8_t>& layer) {
  file.write(reinterpret_cast<const char*>(layer.data()),
             static_cast<std::streamsize>(layer.size()));
}

}  // namespace

PlanView planViewOf(const map::FrozenMap& map) {
  PlanView view;
  view.resolution_m = map.resolution();
  const AxisAlignedBox known = map.knownBounds();
  if (known.isEmpty() || !known.size().allFinite()) return view;
  const Eigen::Vector3d half_voxel = Eigen::Vector3d::Constant(0.5 * map.resolution());
  const map::VoxelIndex first = map.indexOf(known.min + half_voxel);
  const map::VoxelIndex last = map.indexOf(known.max - half_voxel);
  const map::VoxelIndex size = last - first + map::VoxelIndex::Ones();
  view.width = size.x();
  view.height = size.y();
  const Eigen::Vector3d corner = map.centreOf(first) - half_voxel;
  view.origin_m = corner.head<2>();
  view.z_min_m = corner.z();
  const auto cells = static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y());
  view.free.assign(cells, 0);
  view.occupied.assign(cells, 0);
  view.floor.assign(cells, kNone);
  for (int row = 0; row < view.height; row += kSlabRows) {
    const int last_row = std::min(row + kSlabRows, view.height) - 1;
    const map::LocalWindow window(map, {map.centreOf({first.x(), first.y() + row, first.z()}),
                                        map.centreOf({last.x(), first.y() + last_row, last.z()})});
    addSlab(window, first, row, last_row, size.z(), view);
  }
  return view;
}

void writePlanView(const map::FrozenMap& map, const LocalFrame& frame, const std::string& path) {
  const PlanView view = planViewOf(map);
  const Eigen::Vector3d corner =
      frame.toCaller(Eigen::Vector3d(view.origin_m.x(), view.origin_m.y(), view.z_min_m));
  std::ofstream file(path, std::ios::binary);
  file << "plan_view 1 " << view.width << ' ' << view.height << ' ' << toText(corner.x()) << ' '
       << toText(corner.y()) << ' ' << toText(view.resolution_m) << ' ' << toText(corner.z())
       << '\n';
  writeLayer(file, view.free);
  writeLayer(file, view.occupied);
  writeLayer(file, view.floor);
  file.close();
  if (!file) throw OutsideError("cannot write '" + path + "': check the folder's rights and space");
}

}  // namespace spelunk::evaluation
