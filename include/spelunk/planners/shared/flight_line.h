#pragma once

#include "spelunk/common/path.h"
#include "spelunk/graph/path_similarity.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners {

/// Poses along a line that look where they go; the first keeps the heading of `start`.
[[nodiscard]] Path toPath(const graph::Polyline& line, const Pose& start);

/// The path of a line that begins at `root`; first from `pose` out of what blocks the start, if
/// `root` is elsewhere.
[[nodiscard]] Path pathFrom(const Pose& pose, const Eigen::Vector3d& root,
                            const graph::Polyline& line);

/// The result of planHome() for a way home that begins at `root`: kOk, or kNoPath if it is empty.
[[nodiscard]] PlanResult homeResult(const PlanRequest& request, const Eigen::Vector3d& root,
                                    const graph::Polyline& way, const PlanStats& stats);

/// The positions of a path.
[[nodiscard]] graph::Polyline toLine(const Path& path);

}  // namespace spelunk::planners
