#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <memory>
#include <optional>
#include <string>

#include "spelunk/common/local_frame.h"
#include "spelunk/mission/mission.h"
#include "spelunk/ros/markers.h"
#include "spelunk/ros/mission_clock.h"

namespace spelunk::bridge {

/// What the mission looks like at one instant, copied out of its lock; in its own frame.
struct MissionView {
  LocalFrame frame;
  mission::MissionStatus status;  ///< Places in its sentences are in the world frame.
  Pose box;                       ///< The centre of the robot's box.
  Eigen::Vector3d box_m = Eigen::Vector3d::Ones();
  double mark_scale = 1.0;  ///< Size of lines, points and letters.
  Path active_path;
  planners::PathKind kind = planners::PathKind::kLocal;
  std::optional<navigation::NavigationAnswer> go_to;  ///< While it flies to a point.
  Path way_home;
  Path trail;
  AxisAlignedBox bounds;
  std::vector<NoGoZone> zones;
  std::vector<planners::RemainingTarget> remaining;
  std::shared_ptr<const planners::PlannerGraph> graph;  ///< May be missing.
  std::shared_ptr<const map::FrozenMap> map;            ///< May be missing.
  std::shared_ptr<const terrain::TerrainView> terrain;  ///< Robots with legs only.
};

/// Everything planner_node publishes. Nothing is built that nobody has subscribed to, the latched
/// path apart.
///
/// Messages of 64-bit numbers are in the world frame, whatever frame the mission works in. Those of
/// 32-bit numbers, and markers, which RViz turns into such, are in the mission's frame; where that
/// is not the world frame itself, they have the frame id `local_frame`, and /tf_static joins both.
class PlannerOutputs {
 public:
  PlannerOutputs(::ros::NodeHandle& node, const std::string& world_frame,
                 const std::string& local_frame);

  /// Tells tf where the mission's frame lies, if it is not the world frame itself.
  void publishFrame(const LocalFrame& frame, const ::ros::Time& now);

  // --- In the world frame.
  /// The path and the same path timed; empty ones say "stop and hold", and the posture how.
  void publishCommand(const mission::Command& command, const MissionClock& clock,
                      const ::ros::Time& now);
  /// "Stop and hold", whatever the mission commands; from any thread.
  void publishHold(const ::ros::Time& now);
  void publishStatus(const mission::MissionStatus& status, const std::string& input_problem,
                     const ::ros::Time& now);
  void publishGraph(const planners::PlannerGraph& graph, const ::ros::Time& now);

  // --- In the mission's frame.
  void publishMarkers(const MissionView& view, const ::ros::Time& now);
  void publishMapCloud(const MissionView& view, const ::ros::Time& now);
  /// `elevation`, and in the world frame `traversability`; nothing for robots without legs.
  void publishTerrain(const MissionView& view, const ::ros::Time& now);
  /// `octomap` and `octomap_full`, latched.
  void publishOctomap(map::OccupancyMap& map, const LocalFrame& frame, const ::ros::Time& now);

  [[nodiscard]] bool wantsGraph() const { return graph_.getNumSubscribers() > 0; }
  [[nodiscard]] bool wantsMarkers() const { return markers_.getNumSubscribers() > 0; }
  [[nodiscard]] bool wantsMapCloud() const { return map_cloud_.getNumSubscribers() > 0; }
  [[nodiscard]] bool wantsTerrain() const {
    return elevation_.getNumSubscribers() > 0 || traversability_.getNumSubscribers() > 0;
  }
  [[nodiscard]] bool wantsOctomap() const {
    return octomap_.getNumSubscribers() > 0 || octomap_full_.getNumSubscribers() > 0;
  }

 private:
  void publishPosture(Posture posture);
  /// The frame id of what is in a mission's frame.
  [[nodiscard]] const std::string& idOf(const LocalFrame& frame) const {
    return frame.isCallers() ? frame_ : local_frame_;
  }

  std::string frame_;
  std::string local_frame_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
  ::ros::Publisher path_;
  ::ros::Publisher trajectory_;
  ::ros::Publisher stand_;
  ::ros::Publisher status_;
  ::ros::Publisher graph_;
  ::ros::Publisher markers_;
  ::ros::Publisher map_cloud_;
  ::ros::Publisher elevation_;
  ::ros::Publisher traversability_;
  ::ros::Publisher octomap_;
  ::ros::Publisher octomap_full_;
  std::optional<Posture> said_posture_;
  MarkerBuilder marker_builder_;
};

}  // namespace spelunk::bridge
