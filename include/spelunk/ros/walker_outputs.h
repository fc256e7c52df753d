#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>
#include <string>

#include "spelunk/ros/markers.h"
#include "spelunk/sim/simulator.h"

namespace spelunk::bridge {

/// What sim_node publishes of a walking robot only: `joint_states` (sensor_msgs/JointState), `feet`
/// (visualization_msgs/MarkerArray, standing feet white) and `falls` and `slips` (std_msgs/UInt32,
/// how many so far, latched).
class WalkerOutputs {
 public:
  /// `frame`: the frame id of the simulator's frame.
  WalkerOutputs(::ros::NodeHandle& node, const std::string& frame);

  /// `stamp`: the ROS time of the simulator's present time.
  void publish(const sim::Simulator& simulator, const ::ros::Time& stamp);

 private:
  void publishFeet(const sim::Simulator& simulator, const ::ros::Time& stamp);
  void publishCounts(const sim::Simulator& simulator);

  std::string frame_;
  ::ros::Publisher joints_;
  ::ros::Publisher feet_;
  ::ros::Publisher falls_;
  ::ros::Publisher slips_;
  MarkerBuilder marker_builder_;
  double next_feet_s_ = 0.0;
  std::optional<int> falls_said_;
  std::optional<int> slips_said_;
};

}  // namespace spelunk::bridge
