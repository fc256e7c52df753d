#include "spelunk/navigation/path_shortening.h"

#include "spelunk/common/contract.h"

namespace spelunk::navigation {
namespace {

std::size_t farthestWithin(const Path& path, std::size_t from, double reach_m) {
  double arc = 0.0;
  std::size_t last = from + 1;
  for (std::size_t i = from + 1; i < path.size(); ++i) {
    arc += distance(path[i - 1], path[i]);
    if (arc > reach_m) break;
    last = i;
  }
  return last;
}

}  // namespace

Path shortened(const Path& path, map::ConfigurationSpace& space, double reach_m) {
  require(!path.empty(), "shortened: empty path");
  Path kept{path.front()};
  std::size_t at = 0;
  while (at + 1 < path.size()) {
    std::size_t next = farthestWithin(path, at, reach_m);
    while (next > at + 1 && !space.isSweepFree(path[at].position, path[next].position)) --next;
    kept.push_back(path[next]);
    at = next;
  }
  return kept;
}

}  // namespace spelunk::navigation
