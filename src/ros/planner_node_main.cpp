#include <ros/ros.h>

#include <exception>

#include "spelunk/ros/planner_node.h"
#include "spelunk/ros/ros_log.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "planner_node");
  spelunk::bridge::logToRos();
  try {
    spelunk::bridge::PlannerNode node{ros::NodeHandle(), ros::NodeHandle("~")};
    node.run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
