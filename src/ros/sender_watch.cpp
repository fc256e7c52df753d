#include "spelunk/ros/sender_watch.h"

#include <algorithm>

namespace spelunk::bridge {

std::optional<std::pair<std::string, std::string>> SenderWatch::heard(const std::string& thing,
                                                                      const std::string& sender) {
  Turns& turns = turns_[thing];
  if (sender == turns.last) return std::nullopt;
  turns.count = sender == turns.before ? turns.count + 1 : 1;
  turns.before = turns.last;
  turns.last = sender;
  if (turns.count < kTurns) return std::nullopt;
  turns.count = 0;
  const auto [first, second] = std::minmax(turns.last, turns.before);
  const std::pair<std::string, std::string> names(first, second);
  if (!said_.insert({thing, names}).second) return std::nullopt;
  return names;
}

}  // namespace spelunk::bridge
