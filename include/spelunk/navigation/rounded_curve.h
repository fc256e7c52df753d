#pragma once

#include <Eigen/Core>
#include <vector>

#include "spelunk/common/path.h"

namespace spelunk::navigation {

/// One point of a curve by arc length.
struct CurveSample {
  double arc_m = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();
  Eigen::Vector3d curvature = Eigen::Vector3d::Zero();  ///< Towards the centre, 1/m.
  bool is_cusp = false;  ///< The line turns on the spot here: only passable at rest.
};

/// The path's positions with waypoints left out that lie within `tolerance_m` of the straight line
/// between their neighbours that stay. Ends and repeated places: each kept once.
[[nodiscard]] std::vector<Eigen::Vector3d> straightened(const Path& path, double tolerance_m);

/// The path with its corners rounded by circular arcs that stay within `tolerance_m` of it, sampled
/// at most `step_m` apart and wherever the curvature changes. One sample for a path without length.
[[nodiscard]] std::vector<CurveSample> roundedCurve(const Path& path, double tolerance_m,
                                                    double step_m);

}  // namespace spelunk::navigation
