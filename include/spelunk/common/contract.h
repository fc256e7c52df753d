#pragma once

#include <stdexcept>
#include <string>

namespace spelunk {

/// A caller broke the contract of a function. Never an expected outcome.
class Precondition : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Something outside the program is not as it must be: a file, a parameter, a library's set-up.
/// The text names the thing (path, key) and the remedy.
class OutsideError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void require(bool condition, const char* text) {
  if (!condition) throw Precondition(text);
}

}  // namespace spelunk
