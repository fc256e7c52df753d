#include "spelunk/ros/params.h"

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <optional>

#include "spelunk/common/contract.h"

namespace spelunk::bridge {
namespace {

using XmlRpc::XmlRpcValue;

std::optional<std::string> scalarText(XmlRpcValue value) {  // A copy: its casts are not const.
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return toText(static_cast<bool>(value));
    case XmlRpcValue::TypeInt:
      return toText(static_cast<int>(value));
    case XmlRpcValue::TypeDouble:
      return toText(static_cast<double>(value));
    case XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    default:
      return std::nullopt;
  }
}

FlatParam scalarParam(const std::string& name, const XmlRpcValue& value,
                      const std::string& origin) {
  const auto text = scalarText(value);
  if (text) return {name, *text, origin, ""};
  return {name, "", origin, name + " (" + origin + "): must be a number, text or flat list"};
}

FlatParam listParam(const std::string& name, XmlRpcValue list, const std::string& origin) {
  std::string text = "[";
  for (int i = 0; i < list.size(); ++i) {
    const FlatParam item = scalarParam(name, list[i], origin);
    if (!item.problem.empty()) return item;
    text += (i > 0 ? ", " : "") + item.text;
  }
  return {name, text + "]", origin, ""};
}

}  // namespace

std::vector<FlatParam> flattened(const std::string& name, const XmlRpcValue& value,
                                 const std::string& origin) {
  XmlRpcValue copy = value;
  if (copy.getType() == XmlRpcValue::TypeArray) return {listParam(name, copy, origin)};
  if (copy.getType() != XmlRpcValue::TypeStruct) return {scalarParam(name, copy, origin)};
  std::vector<FlatParam> all;
  for (auto& [child, child_value] : copy)
    for (FlatParam& param :
         flattened(name.empty() ? child : name + "." + child, child_value, origin + "/" + child))
      all.push_back(std::move(param));
  return all;
}

PrivateParams readPrivateParams(const ::ros::NodeHandle& private_node) {
  PrivateParams params;
  XmlRpcValue all;
  const std::string& folder = private_node.getNamespace();
  if (!private_node.getParam(folder, all) || all.getType() != XmlRpcValue::TypeStruct)
    return params;
  for (auto& [name, value] : all) {
    if (name != "set") {
      const std::string dotted = name == "cloud" ? name : "node." + name;
      for (FlatParam& param : flattened(dotted, value, folder + "/" + name))
        params.own.push_back(std::move(param));
      continue;
    }
    for (const FlatParam& param : flattened("", value, folder + "/set")) {
      if (!param.problem.empty()) throw OutsideError(param.problem);
      params.assignments.push_back(param.name + "=" + param.text);
    }
  }
  return params;
}

void addTo(ParamTree& tree, const std::vector<FlatParam>& params) {
  for (const FlatParam& param : params) {
    if (param.problem.empty()) {
      tree.set(param.name, param.text, param.origin);
    } else {
      tree.addProblem(param.problem);
    }
  }
}

}  // namespace spelunk::bridge
