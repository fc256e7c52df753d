#pragma once

#include "spelunk/map/local_window.h"

namespace spelunk::planners::gbplanner {

/// What makes unknown space worth looking into.
struct Credibility {
  double closing_height_m = 1.4;
  double opening_height_m = 0.8;
  double opening_width_m = 1.2;
};

/// The window as gains should see it. A LiDAR of a few rows leaves unknown slivers everywhere: gaps
/// between its rows on far walls, wedges above far floors, floor and ceiling next to the robot.
/// Rays cast through them into rock promise volume that nobody can ever see, and a robot that
/// believes them paces. Two steps on the copy:
/// 1. Gaps of a column between two known voxels up to `closing_height_m` become occupied between
///    two occupied voxels, else free.
/// 2. An unknown voxel that touches free space stays open only where free space ends sideways over
///    at least `opening_height_m` of height and no occupied voxel is nearer than half of
///    `opening_width_m`; every other one is sealed (occupied). So holes between the returns from a
///    far wall are no openings, and neither is what the robot could not enter.
/// Differs from the paper, which counts every unknown voxel on a ray (Dang 2020, section 4.1).
/// The result is for gains only and says nothing about collisions.
[[nodiscard]] map::LocalWindow credibleWindow(const map::LocalWindow& window,
                                              const Credibility& credibility);

}  // namespace spelunk::planners::gbplanner
