#include <ros/ros.h>

#include <exception>

#include "spelunk/ros/node_setup.h"
#include "spelunk/ros/ros_log.h"
#include "spelunk/ros/sim_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "sim_node");
  spelunk::bridge::logToRos();
  try {
    const ros::NodeHandle node;
    spelunk::bridge::SimNode simulator(node, spelunk::bridge::loadSimSetup(ros::NodeHandle("~")));
    simulator.run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
