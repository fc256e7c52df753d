#pragma once

#include <string>
#include <vector>

#include "spelunk/common/params.h"

namespace XmlRpc {
class XmlRpcValue;
}
namespace ros {
class NodeHandle;
}

/// What joins spelunk to ROS. (A namespace spelunk::ros would hide ::ros from every file here.)
namespace spelunk::bridge {

/// One value of the parameter server as text.
struct FlatParam {
  std::string name;     ///< Dotted below the value that was flattened: "map.resolution_m".
  std::string text;     ///< Flat lists as "[a, b]".
  std::string origin;   ///< Where it came from, for messages.
  std::string problem;  ///< Not empty: no parameter can be like that (nested list, binary).
};

/// A value with all that lies below it, in the order of names.
[[nodiscard]] std::vector<FlatParam> flattened(const std::string& name,
                                               const XmlRpc::XmlRpcValue& value,
                                               const std::string& origin);

/// The private parameters of a node.
struct PrivateParams {
  std::vector<std::string> assignments;  ///< What lies in ~set, as --set of the mission executable
                                         ///< has it: ~set/map/resolution_m is "map.resolution_m=".
  std::vector<FlatParam> own;            ///< ~x as "node.x"; ~cloud/x as "cloud.x".
};

[[nodiscard]] PrivateParams readPrivateParams(const ros::NodeHandle& private_node);

/// Adds parameters to a tree, those that cannot be one as problems.
void addTo(ParamTree& tree, const std::vector<FlatParam>& params);

}  // namespace spelunk::bridge
