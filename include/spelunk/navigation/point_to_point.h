#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/path.h"
#include "spelunk/common/rng.h"
#include "spelunk/map/frozen_map.h"

namespace spelunk::navigation {

enum class PointToPointStatus { kOk, kStartBlocked, kGoalBlocked, kOutOfBounds, kNoPath };

[[nodiscard]] const char* toText(PointToPointStatus status);

struct PointToPointRequest {
  std::shared_ptr<const map::FrozenMap> map;
  Pose start;
  Pose goal;
  Eigen::Vector3d box = Eigen::Vector3d::Ones();  ///< Robot, full extents, metres.
  AxisAlignedBox bounds;
  std::vector<NoGoZone> zones;
  int iterations = 20000;  ///< Tree extensions tried at most.
  Rng rng{0};
};

struct PointToPointResult {
  PointToPointStatus status = PointToPointStatus::kNoPath;
  std::string reason;  ///< One sentence.
  Path path;           ///< From start to goal; empty unless status is kOk.
  int samples = 0;
};

/// A collision-free path from start to goal through known free space, by RRT-Connect (Kuffner and
/// LaValle, "RRT-Connect: an efficient approach to single-query path planning", ICRA 2000) as OMPL
/// has it, then shortened. The same request gives the same path. Throws Precondition if the map is
/// missing or a pose is not finite.
[[nodiscard]] PointToPointResult planPointToPoint(const PointToPointRequest& request);

}  // namespace spelunk::navigation
