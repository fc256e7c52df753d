#include "spelunk/ros/frame_names.h"

namespace spelunk::bridge {

std::string frameName(const std::string& given) {
  const std::size_t first = given.find_first_not_of('/');
  return first == std::string::npos ? "" : given.substr(first);
}

std::string prefixed(const std::string& prefix, const std::string& frame) {
  const std::size_t first = prefix.find_first_not_of('/');
  if (first == std::string::npos) return frame;
  return prefix.substr(first, prefix.find_last_not_of('/') + 1 - first) + "/" + frame;
}

std::string withoutPrefix(const std::string& prefix, const std::string& frame) {
  const std::string lead = prefixed(prefix, "");
  return frame.compare(0, lead.size(), lead) == 0 ? frame.substr(lead.size()) : frame;
}

std::string localFrame(const PlannerNodeParams& params) {
  return prefixed(params.frame_prefix, "local_map");
}

}  // namespace spelunk::bridge
