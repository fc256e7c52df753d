#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bench.h"
#include "navigation/tree_search.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/path.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/map/free_voxels.h"

namespace spelunk::benchmark {
namespace {

const Eigen::Vector3d kBox(1.1, 1.1, 0.4);
constexpr int kQueries = 6;
constexpr int kCandidates = 4000;
constexpr int kIterations = 3000;
constexpr double kShortest_m = 30.0;
constexpr double kLongest_m = 90.0;

struct Ends {
  Eigen::Vector3d start;
  Eigen::Vector3d goal;
};

using Line = std::vector<Eigen::Vector3d>;
using IsFree = std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

/// A-NAV to a known goal (its search and its path simplification), whatever checks the box.
Line lineBetween(const Ends& ends, const map::FreeVoxels& free, const AxisAlignedBox& region,
                 const IsFree& is_free) {
  navigation::TreeTask task;
  task.start = ends.start;
  task.goal = ends.goal;
  task.region = region;
  task.iterations = kIterations;
  task.time_limit_s = std::numeric_limits<double>::infinity();
  task.draw = [&](Rng& rng) { return *free.draw(rng); };
  task.is_free = is_free;
  return navigation::growTrees(task, Rng(3)).line;
}

double lengthOf(const Line& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

/// Pairs of free places that a way of 30 to 90 m joins.
std::vector<Ends> chosenEnds(const map::FreeVoxels& free, const AxisAlignedBox& region,
                             map::ConfigurationSpace& space) {
  Rng rng(12);
  std::vector<Eigen::Vector3d> places;
  for (int k = 0; k < kCandidates && places.size() < 400; ++k)
    if (const auto place = free.draw(rng); place && space.isFree(*place)) places.push_back(*place);
  const IsFree is_free = [&](const auto& a, const auto& b) { return space.isSweepFree(a, b); };
  std::vector<Ends> chosen;
  for (std::size_t i = 0; i + 1 < places.size() && chosen.size() < kQueries; i += 2) {
    const Ends ends{places[i], places[i + 1]};
    if ((ends.goal - ends.start).norm() < 0.8 * kShortest_m) continue;
    const double length = lengthOf(lineBetween(ends, free, region, is_free));
    if (length >= kShortest_m && length <= kLongest_m) chosen.push_back(ends);
  }
  if (chosen.size() < kQueries) throw OutsideError("the benchmark finds too few long ways");
  return chosen;
}

}  // namespace

std::vector<Row> navigationRows(KnownMine& mine) {
  const auto frozen = mine.map.freeze();
  const AxisAlignedBox region = frozen->knownBounds();
  const map::FreeVoxels free(frozen, region);
  map::ConfigurationSpace chooser(kBox, frozen);
  const std::vector<Ends> chosen = chosenEnds(free, region, chooser);
  std::vector<Line> ours;
  std::vector<Line> plain;
  const double plain_s = secondsOf([&] {
    for (const Ends& ends : chosen)
      plain.push_back(lineBetween(ends, free, region, [&](const auto& a, const auto& b) {
        return isSweepFreePlainly(mine.tree, a, b, kBox);
      }));
  });
  const double ours_s = secondsOf([&] {
    map::ConfigurationSpace space(kBox, frozen);  // nothing is inflated yet
    for (const Ends& ends : chosen)
      ours.push_back(lineBetween(ends, free, region, [&](const auto& a, const auto& b) {
        return space.isSweepFree(a, b);
      }));
  });
  double longest = 0.0;
  for (const Line& line : ours) longest = std::max(longest, lengthOf(line));
  const double to_ms = 1e3 / kQueries;
  return {{"A-NAV query, ways of 30 to " + std::to_string(static_cast<int>(longest)) + " m",
           "every voxel of the box by search at each step", "ms a query", plain_s * to_ms,
           ours_s * to_ms, 20.0, ours == plain, "each of the ways, point by point"}};
}

}  // namespace spelunk::benchmark
