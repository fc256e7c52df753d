#pragma once

#include <string>

namespace spelunk::mission {

/// What is wrong with the inputs, for people: what is seen and the remedy. Empty if nothing is.
struct InputNotes {
  std::string problem;  ///< The robot must not move: it is not started, or holds, with this reason.
  std::string doubt;    ///< Explains why there is no way for the robot, if that comes to pass.
  std::string flaw;     ///< Spoils the map for sure: also said where the mission ends as explored.
};

}  // namespace spelunk::mission
