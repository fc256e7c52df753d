#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace spelunk::bridge {

/// Notices that two nodes send what only one may send: a frame on /tf, or /clock.
/// They take turns then; a node that was restarted under another name does not. Not thread-safe.
class SenderWatch {
 public:
  /// Notes that `sender` sent `thing`. The names of both, in alphabetical order, once a thing and
  /// pair of nodes; nothing otherwise.
  std::optional<std::pair<std::string, std::string>> heard(const std::string& thing,
                                                           const std::string& sender);

 private:
  static constexpr int kTurns = 4;  ///< So often the sender changed from one to the other.

  struct Turns {
    std::string last;
    std::string before;  ///< The one before the last, or empty.
    int count = 0;       ///< Changes between these two.
  };
  std::map<std::string, Turns> turns_;
  std::set<std::pair<std::string, std::pair<std::string, std::string>>> said_;
};

}  // namespace spelunk::bridge
