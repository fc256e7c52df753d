#include "spelunk/ros/params.h"

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace spelunk::bridge {
namespace {

using XmlRpc::XmlRpcValue;

/// The text of a scalar; empty and `false` in `known` for anything else.
struct ScalarText {
  bool known = true;
  std::string text;
};

ScalarText scalarText(XmlRpcValue value) {  // By value: the casts of XmlRpcValue are not const.
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean: return {true, toText(static_cast<bool>(value))};
    case XmlRpcValue::TypeInt: return {true, toText(static_cast<int>(value))};
    case XmlRpcValue::TypeDouble: return {true, toText(static_cast<double>(value))};
    case XmlRpcValue::TypeString: return {true, static_cast<std::string>(value)};
    default: return {false, ""};
  }
}

void addList(const std::string& name, XmlRpcValue value, const std::string& origin,
             ParamTree& tree) {
  std::string text = "[";
  for (int i = 0; i < value.size(); ++i) {
    const ScalarText item = scalarText(value[i]);
    if (!item.known)
      return tree.addProblem(name + " (" + origin + "): only flat lists of numbers or texts");
    text += (i > 0 ? ", " : "") + item.text;
  }
  tree.set(name, text + "]", origin);
}

}  // namespace

void addXmlRpc(const std::string& name, const XmlRpcValue& value, const std::string& origin,
               ParamTree& tree) {
  XmlRpcValue copy = value;
  if (copy.getType() == XmlRpcValue::TypeStruct) {
    for (auto& [child, child_value] : copy)
      addXmlRpc(name.empty() ? child : name + "." + child, child_value, origin + "/" + child, tree);
  } else if (copy.getType() == XmlRpcValue::TypeArray) {
    addList(name, copy, origin, tree);
  } else {
    const ScalarText scalar = scalarText(copy);
    if (!scalar.known) return tree.addProblem(name + " (" + origin + "): not a number or text");
    tree.set(name, scalar.text, origin);
  }
}

void addPrivateParams(const ::ros::NodeHandle& private_node, ParamTree& tree) {
  XmlRpcValue all;
  if (!private_node.getParam(private_node.getNamespace(), all)) return;
  if (all.getType() != XmlRpcValue::TypeStruct) return;
  for (auto& [name, value] : all) {
    const std::string origin = private_node.getNamespace() + "/" + name;
    if (name == "set") {
      addXmlRpc("", value, origin, tree);
    } else if (name == "cloud") {
      addXmlRpc("cloud", value, origin, tree);
    } else {
      addXmlRpc("node." + name, value, origin, tree);
    }
  }
}

}  // namespace spelunk::bridge
