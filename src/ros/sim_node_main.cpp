#include <ros/node_handle.h>

#include "spelunk/ros/node_main.h"
#include "spelunk/ros/node_setup.h"
#include "spelunk/ros/robot_description.h"
#include "spelunk/ros/sim_node.h"

namespace {

void simulate() {
  const ros::NodeHandle node;
  const spelunk::bridge::SimSetup setup = spelunk::bridge::loadSimSetup(ros::NodeHandle("~"));
  // Before the world is opened, which may take a while: others wait for the description.
  node.setParam("robot_description",
                spelunk::bridge::robotDescription(setup.robot, setup.sim, setup.node.base_frame));
  spelunk::bridge::SimNode simulator(node, setup, spelunk::bridge::openWorld(setup));
  simulator.run();
}

}  // namespace

int main(int argc, char** argv) {
  return spelunk::bridge::runNode(argc, argv, "sim_node", simulate);
}
