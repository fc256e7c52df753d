#include "spelunk/ros/convert_octomap.h"

#include <octomap/OcTree.h>

#include <sstream>

namespace spelunk::bridge {
namespace {

octomap_msgs::Octomap emptyMsg(const octomap::OcTree& tree, const std::string& frame,
                               const ::ros::Time& stamp) {
  octomap_msgs::Octomap message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.id = tree.getTreeType();
  message.resolution = tree.getResolution();
  return message;
}

void setData(octomap_msgs::Octomap& message, const std::ostringstream& stream) {
  const std::string bytes = stream.str();
  message.data.assign(bytes.begin(), bytes.end());
}

}  // namespace

octomap_msgs::Octomap binaryMsg(const octomap::OcTree& tree, const std::string& frame,
                                const ::ros::Time& stamp) {
  octomap_msgs::Octomap message = emptyMsg(tree, frame, stamp);
  message.binary = true;
  std::ostringstream stream;
  tree.writeBinaryData(stream);
  setData(message, stream);
  return message;
}

octomap_msgs::Octomap fullMsg(const octomap::OcTree& tree, const std::string& frame,
                              const ::ros::Time& stamp) {
  octomap_msgs::Octomap message = emptyMsg(tree, frame, stamp);
  message.binary = false;
  std::ostringstream stream;
  tree.writeData(stream);
  setData(message, stream);
  return message;
}

}  // namespace spelunk::bridge
