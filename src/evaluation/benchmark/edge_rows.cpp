#include <algorithm>
#include <cmath>

#include "bench.h"
#include "spelunk/map/configuration_space.h"

namespace spelunk::benchmark {
namespace {

const Eigen::Vector3d kBox(1.4, 1.4, 0.5);
constexpr double kFaceTolerance = 1e-4;
constexpr int kEdges = 5000;

struct Edge {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
};

enum class Ends { kFreeVoxels, kFreeBoxes };

std::vector<Edge> edgesIn(const map::LocalWindow& window, map::ConfigurationSpace space,
                          const Eigen::Vector3d& middle, Ends ends) {
  Rng rng(ends == Ends::kFreeBoxes ? 1 : 2);
  std::vector<Edge> edges;
  const auto isGood = [&](const Eigen::Vector3d& point) {
    return ends == Ends::kFreeBoxes ? space.isFree(point)
                                    : window.at(point) == map::Occupancy::kFree;
  };
  while (edges.size() < kEdges) {
    const Eigen::Vector3d a = freePoint(window, rng, middle, {16.0, 16.0, 1.8});
    const double azimuth = rng.uniform(-M_PI, M_PI);
    const double elevation = rng.uniform(-0.3, 0.3);
    const Eigen::Vector3d b =
        a + rng.uniform(1.0, 3.0) * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                    std::cos(elevation) * std::sin(azimuth),
                                                    std::sin(elevation));
    if (isGood(a) && isGood(b)) edges.push_back({a, b});
  }
  return edges;
}

/// Moments at which a face moving by `way` voxels enters the next voxel, as shares of the way.
void addEntries(double face, double way, std::vector<double>& moments) {
  if (way == 0.0) return;
  const double first = way > 0.0 ? std::floor(face) + 1.0 - face : face - std::floor(face);
  for (double voxels = first; voxels <= std::fabs(way); voxels += 1.0)
    moments.push_back(voxels / std::fabs(way));
}

Row edgeRow(KnownMine& mine, Ends ends, const std::string& what) {
  const auto frozen = mine.map.freeze();
  const map::LocalWindow window(*frozen, boxAround(mine.middle, {40.0, 40.0, 6.0}));
  const std::vector<Edge> edges =
      edgesIn(window, map::ConfigurationSpace(kBox, frozen), mine.middle, ends);
  std::vector<char> plain(edges.size());
  std::vector<char> ours(edges.size());
  double plain_s = 0.0;
  double ours_s = 0.0;
  plain_s += secondsOf([&] {
    for (std::size_t i = 0; i < edges.size(); ++i)
      plain[i] = isSweepFreePlainly(mine.tree, edges[i].a, edges[i].b, kBox) ? 1 : 0;
  });
  constexpr int kRounds = 5;
  for (int round = 0; round < kRounds; ++round)
    ours_s += secondsOf([&] {
      map::ConfigurationSpace space(kBox, frozen);
      for (std::size_t i = 0; i < edges.size(); ++i)
        ours[i] = space.isSweepFree(edges[i].a, edges[i].b) ? 1 : 0;
    });
  const auto free = std::count(plain.begin(), plain.end(), 1);
  const double to_us = 1e6 / static_cast<double>(edges.size());
  return {"edge check, " + what + " (" + std::to_string(100 * free / kEdges) + " % free)",
          "every voxel of the box by search at each step",
          "us an edge",
          plain_s * to_us,
          ours_s * to_us / kRounds,
          150.0,
          plain == ours,
          "each of 5000 answers"};
}

}  // namespace

bool isBoxFreePlainly(const octomap::OcTree& tree, const Eigen::Vector3d& centre,
                      const Eigen::Vector3d& size) {
  const double inverse = 1.0 / tree.getResolution();
  const Eigen::Vector3d half = 0.5 * size.array() - kFaceTolerance;
  const map::VoxelIndex first = ((centre - half) * inverse).array().floor().cast<int>();
  const map::VoxelIndex last = ((centre + half) * inverse).array().floor().cast<int>();
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x)
        if (statusIn(tree, {x, y, z}) != map::Occupancy::kFree) return false;
  return true;
}

bool isSweepFreePlainly(const octomap::OcTree& tree, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& size) {
  constexpr double kJustAfter = 1e-9;
  const Eigen::Vector3d half = 0.5 * size.array() - kFaceTolerance;
  std::vector<double> moments{0.0, 1.0};
  for (int axis = 0; axis < 3; ++axis) {
    const double way = (b(axis) - a(axis)) / tree.getResolution();
    const double face = a(axis) + (way > 0.0 ? half(axis) : -half(axis));
    addEntries(face / tree.getResolution(), way, moments);
  }
  std::sort(moments.begin(), moments.end());
  for (const double moment : moments)
    if (!isBoxFreePlainly(tree, a + (b - a) * std::min(1.0, moment + kJustAfter), size))
      return false;
  return true;
}

std::vector<Row> edgeRows(KnownMine& mine) {
  return {edgeRow(mine, Ends::kFreeVoxels, "from free voxels"),
          edgeRow(mine, Ends::kFreeBoxes, "from free boxes")};
}

}  // namespace spelunk::benchmark
