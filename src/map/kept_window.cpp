#include "spelunk/map/kept_window.h"

#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

/// Whether the window has every voxel that `region` touches.
bool holds(const LocalWindow& window, const AxisAlignedBox& region) {
  const VoxelIndex first = window.indexOf(region.min) - window.origin();
  const VoxelIndex last = window.indexOf(region.max) - window.origin();
  return (first.array() >= 0).all() && (last.array() < window.size().array()).all();
}

}  // namespace

const LocalWindow& KeptWindow::over(const std::shared_ptr<const FrozenMap>& map,
                                    const AxisAlignedBox& region) {
  require(map != nullptr, "KeptWindow: no map");
  const bool fits =
      window_ && map->resolution() == window_->resolution() && holds(*window_, region);
  if (!fits) {
    window_.reset();  // before the next one takes its memory
    window_.emplace(*map, AxisAlignedBox{region.min - slack_, region.max + slack_});
  } else if (map_ != map) {
    window_->update(*map_, *map);
  }
  map_ = map;
  return *window_;
}

void KeptWindow::forget() {
  window_.reset();
  map_.reset();
}

AxisAlignedBox roundedOut(const FrozenMap& map, const AxisAlignedBox& region) {
  const double side = map.resolution();
  const VoxelIndex last = map.indexOf(region.max) + VoxelIndex::Ones();
  return {map.indexOf(region.min).cast<double>() * side, last.cast<double>() * side};
}

}  // namespace spelunk::map
