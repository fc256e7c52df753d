#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

namespace spelunk {

/// A closed axis-aligned box in the world frame, metres.
struct AxisAlignedBox {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
  Eigen::Vector3d max = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());

  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const {
    return (point.array() >= min.array()).all() && (point.array() <= max.array()).all();
  }
  [[nodiscard]] bool isEmpty() const { return (min.array() > max.array()).any(); }
  [[nodiscard]] Eigen::Vector3d size() const { return max - min; }
};

/// The common part of two boxes; `isEmpty()` if they do not meet.
AxisAlignedBox intersection(const AxisAlignedBox& a, const AxisAlignedBox& b);

/// The box of full extents `size` centred at `centre`.
AxisAlignedBox boxAround(const Eigen::Vector3d& centre, const Eigen::Vector3d& size);

/// The smallest box around both.
AxisAlignedBox hull(const AxisAlignedBox& a, const AxisAlignedBox& b);

/// A vertical prism no robot may enter: a simple polygon in the plane between two heights.
struct NoGoZone {
  std::string name;
  std::vector<Eigen::Vector2d> polygon;  ///< World x, y; at least three corners, either direction.
  double z_min = -std::numeric_limits<double>::infinity();
  double z_max = std::numeric_limits<double>::infinity();
};

/// Whether `point` lies inside the prism (its border belongs to it).
bool contains(const NoGoZone& zone, const Eigen::Vector3d& point);

/// Whether an axis-aligned box of full extents `box_size`, moved from `a` to `b`, meets the prism.
/// Exact up to the box's diagonal sweep: never answers "no" for a sweep that meets it.
bool sweptBoxMeets(const NoGoZone& zone, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& box_size);

}  // namespace spelunk
