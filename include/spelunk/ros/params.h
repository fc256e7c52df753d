#pragma once

#include <string>

#include "spelunk/common/params.h"

namespace XmlRpc {
class XmlRpcValue;
}
namespace ros {
class NodeHandle;
}

/// What joins spelunk to ROS. (A namespace spelunk::ros would hide ::ros from every file here.)
namespace spelunk::bridge {

/// Adds a value of the parameter server under `name`; structs are flattened to dotted names, flat
/// lists become "[a, b]". Values that no parameter can have (nested lists, binary) become
/// problems of the tree. `origin` is named in messages.
void addXmlRpc(const std::string& name, const XmlRpc::XmlRpcValue& value,
               const std::string& origin, ParamTree& tree);

/// The private parameters of a node: ~x becomes "node.x", but what lies in ~set becomes a
/// parameter of the run, as --set gives it to the mission executable (~set/map/resolution_m is
/// "map.resolution_m"; a name without section is resolved when it is read), and what lies in
/// ~cloud keeps its section.
void addPrivateParams(const ros::NodeHandle& private_node, ParamTree& tree);

}  // namespace spelunk::bridge
