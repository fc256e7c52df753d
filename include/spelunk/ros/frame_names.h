#pragma once

#include <string>

#include "spelunk/ros/node_params.h"

namespace spelunk::bridge {

/// A frame's name as tf2 knows it: without the slashes that tf1 put before it.
[[nodiscard]] std::string frameName(const std::string& given);

/// "robot_1" and "base_link" make "robot_1/base_link", as tf_prefix does; with or without slashes
/// around the prefix. An empty prefix changes nothing.
[[nodiscard]] std::string prefixed(const std::string& prefix, const std::string& frame);

/// The other way round: a frame without that prefix stays as it is.
[[nodiscard]] std::string withoutPrefix(const std::string& prefix, const std::string& frame);

/// The frame in which planner_node publishes what has 32-bit numbers, where the map does not work
/// in the world frame itself.
[[nodiscard]] std::string localFrame(const PlannerNodeParams& params);

}  // namespace spelunk::bridge
