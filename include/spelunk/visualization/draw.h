#pragma once

#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/path.h"
#include "spelunk/mission/mission.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/visualization/scene.h"

namespace spelunk::visualization {

/// Each layer of a planner's graph: "graph/<name>" holds its edges, "gain/<name>" its vertices
/// with a gain, coloured from blue (little) to red (the most in this layer), and
/// "frontier/<name>" its frontier vertices. The layer "reachability" has "explored/reachability"
/// instead of the last: red vertices are not explored, green ones are.
void drawGraph(const planners::PlannerGraph& graph, Scene& scene);

/// What a navigation query found: its trees (layer "navigation/trees") and its path, in two colours
/// where it leads through known space ("navigation/known") and beyond ("navigation/unknown").
void drawNavigation(const navigation::NavigationAnswer& answer, Scene& scene);

/// The path the robot follows (layer "path"), coloured by its kind, its end marked.
void drawActivePath(const Path& path, planners::PathKind kind, Scene& scene);

void drawWayHome(const Path& path, Scene& scene);  ///< Layer "way_home".
void drawTrail(const Path& path, Scene& scene);    ///< Layer "trail".

/// The edges of the box (layer "bounds"). Open sides are drawn where `shown` ends; a box that is
/// open on every side is not drawn at all.
void drawBounds(const AxisAlignedBox& bounds, const AxisAlignedBox& shown, Scene& scene);

/// Prisms as edges with their names (layer "no_go_zones"); open heights end where `shown` does.
void drawZones(const std::vector<NoGoZone>& zones, const AxisAlignedBox& shown, Scene& scene);

/// The robot's box and heading (layer "robot").
void drawRobot(const Pose& pose, const Eigen::Vector3d& box_m, Scene& scene);

/// Places that were left unexplored, with the reason (layer "remaining").
void drawRemaining(const std::vector<planners::RemainingTarget>& remaining, Scene& scene);

/// State, explored volume, endurance, margin and the reason of the last "no", `text_height_m`
/// high, above `anchor` (layer "status").
void drawStatus(const mission::MissionStatus& status, const Eigen::Vector3d& anchor,
                double text_height_m, Scene& scene);

/// The text that drawStatus shows: one line a fact, the reason broken at about 48 columns.
[[nodiscard]] std::string statusText(const mission::MissionStatus& status);

}  // namespace spelunk::visualization
