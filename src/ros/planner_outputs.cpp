#include "spelunk/ros/planner_outputs.h"

#include <octomap/OcTree.h>
#include <std_msgs/Bool.h>
#include <visualization_msgs/MarkerArray.h>

#include "spelunk/ros/convert.h"
#include "spelunk/ros/convert_octomap.h"
#include "spelunk/ros/convert_terrain.h"
#include "spelunk/visualization/draw.h"

namespace spelunk::bridge {
namespace {

constexpr double kStatusTextHeight_m = 0.9;
constexpr double kStatusTextAbove_m = 9.0;

visualization::Scene sceneOf(const MissionView& view) {
  visualization::Scene scene;
  const AxisAlignedBox around_robot = boxAround(view.box.position, {40.0, 40.0, 10.0});
  const AxisAlignedBox known = view.map ? view.map->knownBounds() : AxisAlignedBox();
  const bool map_is_known = known.min.allFinite() && known.max.allFinite() && !known.isEmpty();
  const AxisAlignedBox shown = map_is_known ? known : around_robot;
  if (view.graph) visualization::drawGraph(*view.graph, scene);
  if (view.go_to) visualization::drawNavigation(*view.go_to, scene);
  visualization::drawTrail(view.trail, scene);
  visualization::drawWayHome(view.way_home, scene);
  visualization::drawActivePath(view.active_path, view.kind, scene);
  visualization::drawBounds(view.bounds, shown, scene);
  visualization::drawZones(view.zones, shown, scene);
  visualization::drawRemaining(view.remaining, scene);
  visualization::drawRobot(view.box, view.box_m, scene);
  visualization::drawStatus(
      view.status,
      view.box.position + Eigen::Vector3d(0.0, 0.0, kStatusTextAbove_m * view.mark_scale),
      kStatusTextHeight_m, scene);
  return visualization::withMarksScaled(scene, view.mark_scale);
}

}  // namespace

PlannerOutputs::PlannerOutputs(::ros::NodeHandle& node, const std::string& world_frame,
                               const std::string& local_frame)
    : frame_(world_frame),
      local_frame_(local_frame),
      path_(node.advertise<nav_msgs::Path>("path", 1, /*latch=*/true)),
      trajectory_(
          node.advertise<trajectory_msgs::MultiDOFJointTrajectory>("command/trajectory", 1)),
      stand_(node.advertise<std_msgs::Bool>("command/stand", 1, /*latch=*/true)),
      status_(node.advertise<PlannerStatus>("status", 10)),
      graph_(node.advertise<Graph>("graph", 1)),
      markers_(node.advertise<visualization_msgs::MarkerArray>("markers", 1)),
      map_cloud_(node.advertise<sensor_msgs::PointCloud2>("map_cloud", 1)),
      elevation_(node.advertise<sensor_msgs::PointCloud2>("elevation", 1)),
      traversability_(node.advertise<nav_msgs::OccupancyGrid>("traversability", 1)),
      octomap_(node.advertise<octomap_msgs::Octomap>("octomap", 1, /*latch=*/true)),
      octomap_full_(node.advertise<octomap_msgs::Octomap>("octomap_full", 1, /*latch=*/true)) {}

void PlannerOutputs::publishFrame(const LocalFrame& frame, const ::ros::Time& now) {
  if (frame.isCallers()) return;
  broadcaster_.sendTransform(frameMsg(frame, frame_, local_frame_, now));
}

void PlannerOutputs::publishCommand(const mission::Command& command, const MissionClock& clock,
                                    const ::ros::Time& now) {
  publishPosture(command.posture);
  path_.publish(bridge::toMsg(command.path, frame_, now));
  if (trajectory_.getNumSubscribers() == 0) return;
  const ::ros::Time start =
      command.trajectory.empty() ? now : clock.toRos(command.trajectory.front().time_s);
  trajectory_.publish(bridge::toMsg(command.trajectory, frame_, start));
}

void PlannerOutputs::publishPosture(Posture posture) {
  if (said_posture_ == posture) return;
  said_posture_ = posture;
  std_msgs::Bool stand;
  stand.data = posture == Posture::kStand;
  stand_.publish(stand);
}

void PlannerOutputs::publishHold(const ::ros::Time& now) {
  path_.publish(bridge::toMsg(Path(), frame_, now));
  trajectory_.publish(bridge::toMsg(Trajectory(), frame_, now));
}

void PlannerOutputs::publishStatus(const mission::MissionStatus& status,
                                   const std::string& input_problem, const ::ros::Time& now) {
  if (status_.getNumSubscribers() == 0) return;
  PlannerStatus message = bridge::toMsg(status, frame_, now);
  message.input_problem = input_problem;
  status_.publish(message);
}

void PlannerOutputs::publishGraph(const planners::PlannerGraph& graph, const ::ros::Time& now) {
  if (wantsGraph()) graph_.publish(bridge::toMsg(graph, frame_, now));
}

void PlannerOutputs::publishMarkers(const MissionView& view, const ::ros::Time& now) {
  if (wantsMarkers()) markers_.publish(marker_builder_.build(sceneOf(view), idOf(view.frame), now));
}

void PlannerOutputs::publishMapCloud(const MissionView& view, const ::ros::Time& now) {
  if (!wantsMapCloud()) return;
  const map::FrozenMap& map = *view.map;
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(map.occupiedVoxels());
  if (map.occupiedVoxels() > 0)
    map.forEachOccupied(map.knownBounds(), [&](const map::VoxelIndex& index) {
      centres.push_back(map.centreOf(index).cast<float>());
    });
  map_cloud_.publish(bridge::toMsg(centres, idOf(view.frame), now));
}

void PlannerOutputs::publishTerrain(const MissionView& view, const ::ros::Time& now) {
  if (!view.terrain) return;
  if (elevation_.getNumSubscribers() > 0)
    elevation_.publish(elevationMsg(*view.terrain, idOf(view.frame), now));
  if (traversability_.getNumSubscribers() == 0) return;
  nav_msgs::OccupancyGrid grid = traversabilityMsg(*view.terrain, frame_, now);
  const auto corner = fromMsg(grid.info.origin);
  if (corner.value) grid.info.origin = bridge::toMsg(poseOf(view.frame.toCaller(*corner.value)));
  traversability_.publish(grid);
}

void PlannerOutputs::publishOctomap(map::OccupancyMap& map, const LocalFrame& frame,
                                    const ::ros::Time& now) {
  const octomap::OcTree& tree = map.octree();
  if (tree.size() == 0) return;  // Readers would take it for a world that is all occupied.
  const std::string& id = idOf(frame);
  if (octomap_.getNumSubscribers() > 0) octomap_.publish(binaryMsg(tree, id, now));
  if (octomap_full_.getNumSubscribers() > 0) octomap_full_.publish(fullMsg(tree, id, now));
}

}  // namespace spelunk::bridge
