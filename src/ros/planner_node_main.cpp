#include <ros/node_handle.h>

#include "spelunk/ros/node_main.h"
#include "spelunk/ros/planner_node.h"

int main(int argc, char** argv) {
  return spelunk::bridge::runNode(argc, argv, "planner_node", [] {
    spelunk::bridge::PlannerNode node{ros::NodeHandle(), ros::NodeHandle("~")};
    node.run();
  });
}
