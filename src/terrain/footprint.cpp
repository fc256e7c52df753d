#include "spelunk/terrain/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "spelunk/common/contract.h"

namespace spelunk::terrain {
namespace {

/// The robot's rectangle on the ground.
class Rectangle {
 public:
  Rectangle(const Pose& pose, const FootprintParams& params)
      : middle_(pose.position.head<2>()),
        along_(std::cos(pose.yaw), std::sin(pose.yaw)),
        half_(0.5 * params.footprint_length_m, 0.5 * params.footprint_width_m) {}

  [[nodiscard]] bool contains(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d d = point - middle_;
    return std::fabs(d.x() * along_.x() + d.y() * along_.y()) <= half_.x() &&
           std::fabs(d.y() * along_.x() - d.x() * along_.y()) <= half_.y();
  }

  /// Calls `visit` for every cell whose centre lies in the rectangle, row by row.
  template <class Visit>
  void forEachCell(const WindowGrid& grid, Visit&& visit) const {
    const double reach_y = std::fabs(along_.y()) * half_.x() + std::fabs(along_.x()) * half_.y();
    const int last_y = grid.cellOf({0.0, middle_.y() + reach_y}).y();
    for (int y = grid.cellOf({0.0, middle_.y() - reach_y}).y(); y <= last_y; ++y) {
      const double dy = grid.centreOf({0, y}).y() - middle_.y();
      double low = -1e9;
      double high = 1e9;
      narrow(along_.x(), along_.y() * dy, half_.x(), low, high);
      narrow(-along_.y(), along_.x() * dy, half_.y(), low, high);
      if (low > high + grid.cell()) continue;
      // One cell more on each side, then the exact question: rounding must not decide.
      int first = grid.cellOf({middle_.x() + low, 0.0}).x() - 1;
      int last = grid.cellOf({middle_.x() + high, 0.0}).x() + 1;
      while (first <= last && !contains(grid.centreOf({first, y}))) ++first;
      while (last >= first && !contains(grid.centreOf({last, y}))) --last;
      for (int x = first; x <= last; ++x) visit(CellIndex(x, y));
    }
  }

 private:
  /// Where |slope * d + offset| <= limit, with [low, high] as what is left of d.
  static void narrow(double slope, double offset, double limit, double& low, double& high) {
    if (std::fabs(slope) < 1e-9) return;
    const double a = (-limit - offset) / slope;
    const double b = (limit - offset) / slope;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }

  Eigen::Vector2d middle_;
  Eigen::Vector2d along_;
  Eigen::Vector2d half_;
};

/// What lies under one footprint.
struct Tally {
  int cells = 0;
  int unknown = 0;
  int outside = 0;
  std::array<int, 6> by_class{};
  std::vector<Eigen::Vector2d> bad;

  void add(const TerrainView& view, const CellIndex& cell) {
    ++cells;
    if (!view.covers(cell)) {
      ++outside;
      return;
    }
    const GroundClass ground = view.classAt(cell);
    if (ground == GroundClass::kUnknown) {
      ++unknown;
    } else if (ground != GroundClass::kTraversable) {
      ++by_class[static_cast<std::size_t>(ground)];
      bad.push_back(view.grid().centreOf(cell));
    }
  }
};

void describeBad(const Tally& tally, double z, PathGroundCheck& check) {
  const auto most = std::max_element(tally.by_class.begin(), tally.by_class.end());
  check.reason = static_cast<GroundClass>(most - tally.by_class.begin());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& cell : tally.bad) sum += cell;
  const Eigen::Vector2d mean = sum / static_cast<double>(tally.bad.size());
  for (const Eigen::Vector2d& cell : tally.bad)
    check.radius_m = std::max(check.radius_m, (cell - mean).norm());
  check.where = {mean.x(), mean.y(), z};
}

/// Whether the pose is fine; else `check` says why not.
bool passes(const TerrainView& view, const Pose& pose, const FootprintParams& params,
            const std::optional<Rectangle>& borne, PathGroundCheck& check) {
  Tally tally;
  Rectangle(pose, params).forEachCell(view.grid(), [&](const CellIndex& cell) {
    if (borne && borne->contains(view.grid().centreOf(cell))) {
      ++tally.cells;
    } else {
      tally.add(view, cell);
    }
  });
  const double cells = std::max(1, tally.cells);
  const double unknown_share = tally.unknown / cells;
  check.unknown_share = std::max(check.unknown_share, unknown_share);
  check.outside_share = std::max(check.outside_share, tally.outside / cells);
  const double bad_area =
      static_cast<double>(tally.bad.size()) * view.grid().cell() * view.grid().cell();
  if (bad_area > params.bad_area_max_m2) {
    check.status = PathGround::kUntraversable;
    describeBad(tally, pose.position.z(), check);
  } else if (unknown_share > params.unknown_share_max) {
    check.status = PathGround::kUnknown;
    check.reason = GroundClass::kUnknown;
    check.where = pose.position;
  }
  return check.status == PathGround::kTraversable;
}

}  // namespace

PathGroundCheck checkPath(const TerrainView& view, const Path& path, const FootprintParams& params,
                          const std::optional<Pose>& standing) {
  for (const Pose& pose : path) require(isFinite(pose), "checkPath: a pose is not finite");
  require(!standing || isFinite(*standing), "checkPath: the standing pose is not finite");
  PathGroundCheck check;
  if (path.empty()) return check;
  std::optional<Rectangle> borne;
  if (standing) borne.emplace(*standing, params);
  const Path poses = resampled(path, params.pose_spacing_m);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) check.arc_m += distance(poses[i - 1], poses[i]);
    if (!passes(view, poses[i], params, borne, check)) break;
  }
  return check;
}

}  // namespace spelunk::terrain
