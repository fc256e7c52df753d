#include "plain_elevation.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace spelunk::benchmark {

void PlainElevation::insert(const Scan& scan, const Eigen::Isometry3d& T_world_base) {
  const Eigen::Vector3d base = T_world_base.translation();
  const double way = last_ ? (base - *last_).norm() : 0.0;
  const double seconds = last_ ? scan.stamp_s - last_stamp_s_ : 0.0;
  if (way > 1e-4)
    for (auto& [key, cell] : cells_)
      cell.variance += params_.growth_m2_per_m * way + params_.growth_m2_per_s * seconds;
  last_ = base;
  last_stamp_s_ = scan.stamp_s;
  std::map<Key, std::vector<double>> returns;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d at = scan.T_world_sensor * point.cast<double>();
    if (isKept(at, T_world_base)) returns[keyOf(at)].push_back(at.z());
  }
  const double high = base.z() - params_.base_height_m + params_.clearance_m;
  std::vector<const std::pair<const Key, std::vector<double>>*> high_ones;
  for (const auto& entry : returns) {
    if (*std::min_element(entry.second.begin(), entry.second.end()) > high)
      high_ones.push_back(&entry);
    else
      enter(entry.first, entry.second, scan.T_world_sensor.translation());
  }
  std::vector<bool> hang;
  for (const auto* entry : high_ones)
    hang.push_back(
        cells_.count(entry->first) == 0 &&
        hangs(entry->first, *std::min_element(entry->second.begin(), entry->second.end()), base));
  for (std::size_t i = 0; i < high_ones.size(); ++i) {
    if (hang[i]) continue;
    const auto& [key, heights] = *high_ones[i];
    const bool is_new = cells_.count(key) == 0;
    enter(key, heights, scan.T_world_sensor.translation());
    if (is_new) high_[key] = {*std::min_element(heights.begin(), heights.end())};
  }
  for (auto cell = high_.begin(); cell != high_.end();) {
    High& look = cell->second;
    if (--look.wait > 0) {
      ++cell;
      continue;
    }
    look.wait = look.pause = std::min(2 * look.pause, 8);
    const bool is_high = cells_.at(cell->first).height >= look.lowest - 0.1;
    const bool is_hanging = is_high && hangs(cell->first, look.lowest, base);
    if (is_hanging) cells_.erase(cell->first);
    cell = is_high && !is_hanging ? std::next(cell) : high_.erase(cell);
  }
}

std::map<PlainElevation::Key, double> PlainElevation::slopes(
    const terrain::TraversabilityParams& params) const {
  std::map<Key, double> slopes;
  const int plane = static_cast<int>(std::lround(params.slope_window_m / params_.cell_m));
  for (const auto& [key, cell] : cells_) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (int y = -plane; y <= plane; ++y)
      for (int x = -plane; x <= plane; ++x) {
        const auto found = cells_.find({key.first + x, key.second + y});
        if (found == cells_.end()) continue;
        const Eigen::Vector3d row(x * params_.cell_m, y * params_.cell_m, 1.0);
        A += row * row.transpose();
        b += row * (found->second.height - cell.height);
      }
    slopes[key] = A.ldlt().solve(b).head<2>().norm();
  }
  return slopes;
}

PlainElevation::Key PlainElevation::keyOf(const Eigen::Vector3d& point) const {
  return {static_cast<int>(std::floor(point.x() / params_.cell_m)),
          static_cast<int>(std::floor(point.y() / params_.cell_m))};
}

bool PlainElevation::isKept(const Eigen::Vector3d& at, const Eigen::Isometry3d& T) const {
  const Eigen::Vector3d base = T.translation();
  const Key key = keyOf(at);
  const Key middle = keyOf(base);
  const int reach = static_cast<int>(std::ceil(params_.reach_m / params_.cell_m - 1e-9));
  if (std::abs(key.first - middle.first) > reach || std::abs(key.second - middle.second) > reach)
    return false;
  const Eigen::Vector3d in_base = T.inverse() * at;
  if ((in_base.array().abs() <= 0.5 * params_.body_m.array()).all()) return false;
  return at.z() <= base.z() - params_.base_height_m + params_.clearance_m +
                       climb() * (at - base).head<2>().norm();
}

double PlainElevation::climb() const { return std::tan(params_.climb_deg * M_PI / 180.0); }

bool PlainElevation::hangs(const Key& key, double lowest, const Eigen::Vector3d& base) const {
  const Key middle = keyOf(base);
  const Eigen::Vector2d way(middle.first - key.first, middle.second - key.second);
  const double foot = base.z() - params_.base_height_m;
  const double rise = climb() * params_.cell_m;
  for (int at = 2; at < way.norm(); at += 2) {
    const Eigen::Vector2d step = way * (at / way.norm());
    const auto found = cells_.find({key.first + static_cast<int>(std::lround(step.x())),
                                    key.second + static_cast<int>(std::lround(step.y()))});
    if (found == cells_.end()) continue;
    if (found->second.height < foot - rise * (way.norm() - at) - 0.3) continue;
    if (lowest > found->second.height + params_.clearance_m + rise * at) return true;
  }
  return false;
}

void PlainElevation::enter(const Key& key, const std::vector<double>& heights,
                           const Eigen::Vector3d& sensor) {
  const double lowest = *std::min_element(heights.begin(), heights.end());
  const auto found = cells_.find(key);
  if (found != cells_.end() && lowest > found->second.height + params_.clearance_m) return;
  double top = lowest;
  for (const double z : heights)
    if (z <= lowest + params_.clearance_m) top = std::max(top, z);
  double sum = 0.0;
  int count = 0;
  for (const double z : heights)
    if (z <= top && z >= top - 0.1) sum += z, ++count;
  const double measured = sum / count;
  const Eigen::Vector3d centre((key.first + 0.5) * params_.cell_m,
                               (key.second + 0.5) * params_.cell_m, measured);
  const double deviation =
      params_.noise_base_m + params_.noise_quadratic_1pm * (centre - sensor).squaredNorm();
  const double noise =
      deviation * deviation / std::min(count, 4) + params_.cell_m * params_.cell_m / 16.0;
  if (found == cells_.end())
    cells_[key] = {measured, noise};
  else
    fuse(measured, noise, found->second);
}

void PlainElevation::fuse(double measured, double noise, Cell& cell) const {
  const double gate = params_.gate_sigmas * params_.gate_sigmas;
  const double innovation = measured - cell.height;
  const double spread = cell.variance + noise;
  if (innovation * innovation <= gate * spread) {
    cell.height += cell.variance / spread * innovation;
    cell.variance = std::max(9e-6, cell.variance * (1.0 - cell.variance / spread));
    if (cell.other >= cell.height - params_.clearance_m) cell.others = 0;
    return;
  }
  const double apart = measured - cell.other;
  cell.others = cell.others > 0 && apart * apart <= 2.0 * gate * noise ? cell.others + 1 : 1;
  cell.other = measured;
  if (cell.others >= params_.conflicts_to_replace) cell = {measured, noise};
}

}  // namespace spelunk::benchmark
