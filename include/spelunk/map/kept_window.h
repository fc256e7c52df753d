#pragma once

#include <memory>
#include <optional>

#include "spelunk/map/local_window.h"

namespace spelunk::map {

/// A dense window that lives from plan to plan. While it holds what is asked for, only what changed
/// in the map is copied; else it is made anew, larger than asked for, as robots move on.
class KeptWindow {
 public:
  /// `slack`: how much larger on each side, metres.
  explicit KeptWindow(const Eigen::Vector3d& slack) : slack_(slack) {}

  /// A window of `map` that holds at least `region`. Valid until the next call. Throws as
  /// LocalWindow does.
  const LocalWindow& over(const std::shared_ptr<const FrozenMap>& map,
                          const AxisAlignedBox& region);
  void forget();  ///< Gives the memory back.

 private:
  Eigen::Vector3d slack_;
  std::shared_ptr<const FrozenMap> map_;
  std::optional<LocalWindow> window_;
};

/// Around the voxels that `region` touches.
[[nodiscard]] AxisAlignedBox roundedOut(const FrozenMap& map, const AxisAlignedBox& region);

}  // namespace spelunk::map
