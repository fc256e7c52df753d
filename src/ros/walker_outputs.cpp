#include "spelunk/ros/walker_outputs.h"

#include <std_msgs/UInt32.h>

#include "spelunk/common/log.h"
#include "spelunk/ros/convert_robot.h"

namespace spelunk::bridge {
namespace {

constexpr double kFeetPeriod_s = 0.1;

/// Publishes a count that differs from the one said last; whether it did.
bool sayIfNew(int count, const ::ros::Publisher& publisher, std::optional<int>& said) {
  if (said == count) return false;
  said = count;
  std_msgs::UInt32 message;
  message.data = static_cast<std::uint32_t>(count);
  publisher.publish(message);
  return true;
}

}  // namespace

WalkerOutputs::WalkerOutputs(::ros::NodeHandle& node, const std::string& frame)
    : frame_(frame),
      joints_(node.advertise<sensor_msgs::JointState>("joint_states", 50)),
      feet_(node.advertise<visualization_msgs::MarkerArray>("feet", 2)),
      falls_(node.advertise<std_msgs::UInt32>("falls", 5, /*latch=*/true)),
      slips_(node.advertise<std_msgs::UInt32>("slips", 5, /*latch=*/true)) {}

void WalkerOutputs::publish(const sim::Simulator& simulator, const ::ros::Time& stamp) {
  if (joints_.getNumSubscribers() > 0) joints_.publish(toMsg(simulator.joints(), stamp));
  if (feet_.getNumSubscribers() > 0 && simulator.time() >= next_feet_s_)
    publishFeet(simulator, stamp);
  publishCounts(simulator);
}

void WalkerOutputs::publishFeet(const sim::Simulator& simulator, const ::ros::Time& stamp) {
  next_feet_s_ = simulator.time() + kFeetPeriod_s;
  visualization::Scene scene;
  visualization::drawFeet(marksOf(simulator.feet(), T_world_body(simulator.odometry())), scene);
  feet_.publish(marker_builder_.build(scene, frame_, stamp));
}

void WalkerOutputs::publishCounts(const sim::Simulator& simulator) {
  const sim::WalkerCount count = simulator.walkerCount();
  sayIfNew(count.slips, slips_, slips_said_);
  if (sayIfNew(count.falls, falls_, falls_said_) && count.falls > 0)
    log(LogLevel::kError, "the robot has fallen and stays down: start the simulation anew");
}

}  // namespace spelunk::bridge
