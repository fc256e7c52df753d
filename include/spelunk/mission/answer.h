#pragma once

#include <string>

namespace spelunk::mission {

/// The answer to a request from outside.
struct Answer {
  bool accepted = false;
  std::string reason;
};

}  // namespace spelunk::mission
