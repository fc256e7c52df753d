#include "spelunk/navigation/path_monitor.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::navigation {
namespace {

constexpr double kCell_m = 1.6;   // a few voxels of any usual map, a few pieces of any usual path
constexpr double kPiece_m = 2.0;  // longer sweeps are cut so that each lies in few cells
constexpr double kTouch_m = 1e-9;

std::uint64_t pack(const Eigen::Vector3i& index) {
  constexpr std::uint64_t kMask = (1U << 21U) - 1U;
  return (static_cast<std::uint64_t>(index.x()) & kMask) |
         ((static_cast<std::uint64_t>(index.y()) & kMask) << 21U) |
         ((static_cast<std::uint64_t>(index.z()) & kMask) << 42U);
}

std::size_t hashOf(std::uint64_t cell) { return (cell * 0x9E3779B97F4A7C15ULL) >> 48U; }

Eigen::Vector3i cellIndex(const Eigen::Vector3d& point) {
  return (point / kCell_m).array().floor().cast<int>();
}

/// Where the segment first enters the closed box around `centre`, as a share of it; none if it
/// passes by.
std::optional<double> entry(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
  double from = 0.0;
  double to = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double start = a[axis] - centre[axis];
    const double way = b[axis] - a[axis];
    if (std::abs(way) < 1e-12) {
      if (std::abs(start) > half[axis]) return std::nullopt;
      continue;
    }
    const double first = (-half[axis] - start) / way;
    const double second = (half[axis] - start) / way;
    from = std::max(from, std::min(first, second));
    to = std::min(to, std::max(first, second));
  }
  if (from > to) return std::nullopt;
  return from;
}

}  // namespace

SweptIndex::SweptIndex(const Eigen::Vector3d& box, double resolution_m)
    : half_(0.5 * box), resolution_m_(resolution_m) {
  require(resolution_m > 0.0 && (box.array() >= 0.0).all(), "SweptIndex: bad box or resolution");
}

void SweptIndex::add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::uint32_t id) {
  const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / kPiece_m)));
  for (int k = 0; k < pieces; ++k) {
    const double from = static_cast<double>(k) / pieces;
    const double to = static_cast<double>(k + 1) / pieces;
    addPiece({a + from * (b - a), a + to * (b - a), from, to, id});
  }
}

void SweptIndex::addPiece(const Sweep& sweep) {
  const auto number = static_cast<std::uint32_t>(sweeps_.size());
  sweeps_.push_back(sweep);
  const Eigen::Vector3d reach = half_ + Eigen::Vector3d::Constant(0.5 * resolution_m_ + kTouch_m);
  const Eigen::Vector3i low = cellIndex(sweep.a.cwiseMin(sweep.b) - reach);
  const Eigen::Vector3i high = cellIndex(sweep.a.cwiseMax(sweep.b) + reach);
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) addTo(pack(Eigen::Vector3i(x, y, z)), number);
}

void SweptIndex::addTo(std::uint64_t cell, std::uint32_t number) {
  cells_[cell].push_back(number);
  is_near_.set(hashOf(cell));
}

std::uint64_t SweptIndex::cellOf(const Eigen::Vector3d& point) const {
  return pack(cellIndex(point));
}

std::vector<SweptIndex::Hit> SweptIndex::touching(
    const std::vector<map::VoxelIndex>& voxels) const {
  const Eigen::Vector3d half = half_ + Eigen::Vector3d::Constant(0.5 * resolution_m_ + kTouch_m);
  std::vector<Hit> hits;
  std::optional<std::uint64_t> last;
  auto near = cells_.end();
  for (const map::VoxelIndex& voxel : voxels) {
    const Eigen::Vector3d centre =
        resolution_m_ * (voxel.cast<double>() + Eigen::Vector3d::Constant(0.5));
    const std::uint64_t cell = cellOf(centre);
    if (cell != last) near = is_near_[hashOf(cell)] ? cells_.find(cell) : cells_.end();
    last = cell;
    if (near == cells_.end()) continue;
    for (const std::uint32_t number : near->second) {
      const Sweep& sweep = sweeps_[number];
      if (const auto share = entry(sweep.a, sweep.b, centre, half))
        hits.push_back({sweep.id, sweep.from + *share * (sweep.to - sweep.from)});
    }
  }
  return hits;
}

PathMonitor::PathMonitor(const Path& path, const Eigen::Vector3d& box, double resolution_m)
    : index_(box, resolution_m), arc_m_{0.0} {
  require(!path.empty(), "PathMonitor: empty path");
  if (path.size() == 1) index_.add(path[0].position, path[0].position, 0);
  for (std::size_t i = 1; i < path.size(); ++i) {
    index_.add(path[i - 1].position, path[i].position, static_cast<std::uint32_t>(i - 1));
    arc_m_.push_back(arc_m_.back() + distance(path[i - 1], path[i]));
  }
  if (path.size() == 1) arc_m_.push_back(0.0);
}

std::optional<double> PathMonitor::firstHit(const std::vector<map::VoxelIndex>& voxels,
                                            double from_m) const {
  std::optional<double> first;
  for (const SweptIndex::Hit& hit : index_.touching(voxels)) {
    const double arc = arc_m_[hit.id] + hit.along * (arc_m_[hit.id + 1] - arc_m_[hit.id]);
    if (arc >= from_m && (!first || arc < *first)) first = arc;
  }
  return first;
}

}  // namespace spelunk::navigation
