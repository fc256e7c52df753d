#include <ros/ros.h>

#include <exception>

#include "spelunk/ros/node_setup.h"
#include "spelunk/ros/robot_description.h"
#include "spelunk/ros/ros_log.h"
#include "spelunk/ros/sim_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "sim_node");
  spelunk::bridge::logToRos();
  try {
    const ros::NodeHandle node;
    const spelunk::bridge::SimSetup setup = spelunk::bridge::loadSimSetup(ros::NodeHandle("~"));
    // Before the world is opened, which may take a while: others wait for the description.
    node.setParam("robot_description",
                  spelunk::bridge::robotDescription(setup.robot, setup.sim, setup.node.base_frame));
    spelunk::bridge::SimNode simulator(node, setup, spelunk::bridge::openWorld(setup));
    simulator.run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
