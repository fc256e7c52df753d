#pragma once

#include <functional>
#include <string>

namespace spelunk::bridge {

/// The main function of a node: joins ROS as `name` and runs `body`, which builds the node's own
/// objects. What `body` throws is said on stderr and in ROS's log before ROS ends. Without a master
/// the node says so and does not wait for one. Returns the exit code.
[[nodiscard]] int runNode(int argc, char** argv, const std::string& name,
                          const std::function<void()>& body);

}  // namespace spelunk::bridge
