#pragma once

#include <octomap_msgs/Octomap.h>
#include <ros/time.h>

#include <string>

namespace octomap {
class OcTree;
}

namespace spelunk::bridge {

/// The tree with nothing but free and occupied, as OcTree::readBinaryData takes it.
[[nodiscard]] octomap_msgs::Octomap binaryMsg(const octomap::OcTree& tree, const std::string& frame,
                                              const ::ros::Time& stamp);

/// The tree with every node's value, as OcTree::readData takes it.
[[nodiscard]] octomap_msgs::Octomap fullMsg(const octomap::OcTree& tree, const std::string& frame,
                                            const ::ros::Time& stamp);

}  // namespace spelunk::bridge
