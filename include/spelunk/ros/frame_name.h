#pragma once

#include <string>

namespace spelunk::bridge {

/// A frame's name as tf2 knows it: without the slashes that tf1 put before it.
[[nodiscard]] inline std::string frameName(const std::string& given) {
  const auto first = given.find_first_not_of('/');
  return first == std::string::npos ? "" : given.substr(first);
}

}  // namespace spelunk::bridge
