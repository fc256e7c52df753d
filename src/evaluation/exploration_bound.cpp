#include "spelunk/evaluation/exploration_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "coarse_space.h"
#include "spelunk/common/contract.h"
#include "spelunk/evaluation/reachable_volume.h"
#include "spelunk/evaluation/target_voxels.h"

namespace spelunk::evaluation {
namespace {

/// Sizes of the sets A the bound is taken over.
constexpr std::size_t kSetSizes[] = {0, 2, 4, 8, 16, 32, 64, 128};

/// Steps from the middle of a piece of path to its ends.
constexpr int kHalfPieces[] = {1, 2, 4, 8, 16};

double halfDiagonal(double edge_m) { return 0.5 * std::sqrt(3.0) * edge_m; }

BoundParams coarsened(BoundParams params, const ReachableSpace& space) {
  const double volume_m3 = static_cast<double>(space.free_voxels + space.surface_voxels) *
                           std::pow(space.free.resolution(), 3);
  const double factor = std::max(1.0, std::cbrt(volume_m3 / params.volume_m3));
  params.cell_m *= factor;
  params.target_m *= factor;
  params.grid_m *= factor;
  return params;
}

}  // namespace

struct ExplorationBound::Impl {
  using Seen = std::vector<std::uint64_t>;  ///< One bit a target.

  struct Cell {
    Eigen::Vector3d centre;
    double distance_m;  ///< No way to it is shorter.
    Seen seen;
    std::vector<std::size_t> neighbours;
  };

  /// What pieces of a length add to one set A, by the cell of their middle, the largest first.
  struct Additions {
    double piece_m = 0.0;
    double volume_m3 = 0.0;  ///< Of A itself.
    std::vector<std::pair<double, std::size_t>> by_cell;
  };

  Impl(const sim::WorldMesh& mesh, const Pose& start, const RobotModel& robot,
       const BoundParams& bound_params)
      : speed_mps(robot.speed_max_mps),
        space(reachableSpace(mesh, start.position)),
        params(coarsened(bound_params, space)),
        targets(space, params.target_m) {
    double mount_m = 0.0;
    for (const SensorModel& sensor : robot.sensor_models)
      mount_m = std::max(mount_m, sensor.mount_m.norm());
    const double shift_m =
        std::max(halfDiagonal(params.cell_m) + mount_m, halfDiagonal(params.target_m));
    const double range_m = longestRange(robot) + shift_m + halfDiagonal(params.target_m);
    const double rounding_m =
        2.0 * halfDiagonal(params.grid_m) + halfDiagonal(space.free.resolution());
    const VoxelGrid held =
        coarse(space, mesh.bounds(), shift_m + params.cell_m + 1.0, params.grid_m);
    makeCells(start.position, held);
    look(grown(held, shift_m + rounding_m), range_m);
    addPieces();
  }

  void makeCells(const Eigen::Vector3d& start, const VoxelGrid& held);
  void look(const VoxelGrid& open, double range_m);
  void addPieces();
  void widen(std::vector<Seen>& seen) const;
  void addGreedily(const std::vector<Seen>& seen, double piece_m);
  [[nodiscard]] double added(const Seen& seen, const Seen& before) const;
  [[nodiscard]] double volumeWithin(double distance_m) const;
  [[nodiscard]] double volumeOfPath(double length_m, double distance_m) const;

  double speed_mps;
  ReachableSpace space;
  BoundParams params;
  TargetVoxels targets;
  std::vector<Cell> cells;           ///< By distance.
  std::vector<double> seen_within;   ///< Volume of the union of the cells up to each.
  std::vector<Additions> additions;  ///< One a length of pieces and a set size.
};

void ExplorationBound::Impl::makeCells(const Eigen::Vector3d& start, const VoxelGrid& held) {
  const TargetVoxels positions(space, params.cell_m);
  std::vector<int> fewest(positions.size(), std::numeric_limits<int>::max());
  const std::vector<int> links = linksFrom(start, held);
  const auto take = [&](const VoxelGrid& grid) {
    grid.forEachSet([&](std::size_t offset) {
      const Eigen::Vector3d point = grid.centreOf(grid.cellAt(offset));
      int& best = fewest[*positions.find(point)];
      best = std::min(best, links[offsetAt(held, point)]);
    });
  };
  take(space.free);
  take(space.surface);
  std::vector<std::pair<double, std::size_t>> by_distance;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Array3d beside = (start - positions.centres()[i]).array().abs();
    const double straight_m = (beside - 0.5 * params.cell_m).max(0.0).matrix().norm();
    by_distance.emplace_back(std::max(kLink_m * (fewest[i] - 1), straight_m), i);
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::size_t> place(positions.size());
  for (std::size_t k = 0; k < by_distance.size(); ++k) place[by_distance[k].second] = k;
  const auto around = stencil(1, [](const Eigen::Vector3d& step) { return step.norm() > 0.0; });
  for (const auto& [distance_m, i] : by_distance) {
    Cell cell{positions.centres()[i], distance_m, {}, {}};
    for (const Eigen::Vector3i& step : around)
      if (const auto found = positions.find(cell.centre + params.cell_m * step.cast<double>()))
        cell.neighbours.push_back(place[*found]);
    cells.push_back(std::move(cell));
  }
}

void ExplorationBound::Impl::look(const VoxelGrid& open, double range_m) {
  Seen all((targets.size() + 63) / 64, 0);
  double volume = 0.0;
  for (Cell& cell : cells) {
    cell.seen.assign(all.size(), 0);
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const Eigen::Vector3d& target = targets.centres()[i];
      if ((target - cell.centre).squaredNorm() > range_m * range_m) continue;
      if (isClear(open, cell.centre, target)) cell.seen[i >> 6] |= std::uint64_t{1} << (i & 63);
    }
    volume += added(cell.seen, all);
    for (std::size_t word = 0; word < all.size(); ++word) all[word] |= cell.seen[word];
    seen_within.push_back(volume);
  }
}

double ExplorationBound::Impl::added(const Seen& seen, const Seen& before) const {
  double volume = 0.0;
  for (std::size_t word = 0; word < seen.size(); ++word)
    for (std::uint64_t bits = seen[word] & ~before[word]; bits != 0; bits &= bits - 1)
      volume += targets.volumes_m3()[word * 64 + static_cast<std::size_t>(__builtin_ctzll(bits))];
  return volume;
}

void ExplorationBound::Impl::addPieces() {
  std::vector<Seen> seen;
  for (const Cell& cell : cells) seen.push_back(cell.seen);
  int steps = 0;
  for (const int half : kHalfPieces) {
    for (; steps < half; ++steps) widen(seen);
    addGreedily(seen, 2.0 * half * params.cell_m);
  }
}

/// Adds to what is seen from each cell and around it what is so for its neighbours.
void ExplorationBound::Impl::widen(std::vector<Seen>& seen) const {
  const std::vector<Seen> before = seen;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const std::size_t neighbour : cells[i].neighbours)
      for (std::size_t word = 0; word < seen[i].size(); ++word)
        seen[i][word] |= before[neighbour][word];
}

/// The greedy sets: what was worth most before is looked at again first (it can only have lost).
void ExplorationBound::Impl::addGreedily(const std::vector<Seen>& seen, double piece_m) {
  Seen before((targets.size() + 63) / 64, 0);
  double volume = 0.0;
  std::priority_queue<std::pair<double, std::size_t>> queue;
  for (std::size_t i = 0; i < cells.size(); ++i) queue.emplace(added(seen[i], before), i);
  std::size_t taken = 0;
  for (const std::size_t size : kSetSizes) {
    for (; taken < size && !queue.empty(); ++taken) {
      std::size_t best = 0;
      for (bool is_best = false; !is_best;) {
        best = queue.top().second;
        queue.pop();
        const double now = added(seen[best], before);
        is_best = queue.empty() || now >= queue.top().first;
        if (is_best)
          volume += now;
        else
          queue.emplace(now, best);
      }
      for (std::size_t word = 0; word < before.size(); ++word) before[word] |= seen[best][word];
    }
    Additions set{piece_m, volume, {}};
    for (std::size_t i = 0; i < cells.size(); ++i)
      set.by_cell.emplace_back(added(seen[i], before), i);
    std::stable_sort(set.by_cell.begin(), set.by_cell.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    additions.push_back(std::move(set));
  }
}

double ExplorationBound::Impl::volumeWithin(double distance_m) const {
  const auto end = std::upper_bound(
      cells.begin(), cells.end(), distance_m,
      [](double distance, const Cell& cell) { return distance < cell.distance_m; });
  return end == cells.begin() ? 0.0
                              : seen_within[static_cast<std::size_t>(end - cells.begin()) - 1];
}

double ExplorationBound::Impl::volumeOfPath(double length_m, double distance_m) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Additions& set : additions) {
    const double pieces = std::max(1.0, std::ceil(length_m / set.piece_m));
    double volume = set.volume_m3;
    double used = 0.0;
    for (const auto& [gain, cell] : set.by_cell) {
      if (used == pieces || volume >= least) break;
      if (cells[cell].distance_m > distance_m) continue;
      volume += gain;
      used += 1.0;
    }
    least = std::min(least, volume);
  }
  return least;
}

ExplorationBound::ExplorationBound(const sim::WorldMesh& mesh, const Pose& start,
                                   const RobotModel& robot, const BoundParams& params)
    : impl_(std::make_unique<Impl>(mesh, start, robot, params)) {}
ExplorationBound::~ExplorationBound() = default;

std::optional<Leak> ExplorationBound::leak() const { return impl_->space.leak; }

std::vector<double> ExplorationBound::over(double time_limit_s) const {
  require(time_limit_s > 0.0, "ExplorationBound: the time limit must be positive");
  std::vector<double> bound;
  for (int second = 0; second <= time_limit_s; ++second) {
    const double distance = impl_->speed_mps * std::min<double>(second, 0.5 * time_limit_s);
    const double volume = std::min(impl_->volumeWithin(distance),
                                   impl_->volumeOfPath(impl_->speed_mps * second, distance));
    bound.push_back(bound.empty() ? volume : std::max(volume, bound.back()));
  }
  return bound;
}

}  // namespace spelunk::evaluation
