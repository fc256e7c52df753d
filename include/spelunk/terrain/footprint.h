#pragma once

#include <Eigen/Core>
#include <optional>

#include "spelunk/common/params.h"
#include "spelunk/common/path.h"
#include "spelunk/terrain/terrain_view.h"

namespace spelunk::terrain {

/// Parameters of the check of paths (section "terrain").
struct FootprintParams {
  double footprint_length_m = 1.2;
  double footprint_width_m = 0.85;
  double pose_spacing_m = 0.05;
  double bad_area_max_m2 = 0.005;
  double unknown_share_max = 0.3;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("footprint_length_m", footprint_length_m, Bounds{0.05, 10.0},
          "of the rectangle that must find good ground, along the heading; left out: robot.box_m",
          Audience::kUser);
    field("footprint_width_m", footprint_width_m, Bounds{0.05, 10.0},
          "across; left out: robot.box_m", Audience::kUser);
    field("pose_spacing_m", pose_spacing_m, Bounds{0.01, 1.0}, "between poses looked at");
    field("bad_area_max_m2", bad_area_max_m2, Bounds{0.0, 1.0},
          "untraversable ground in a footprint that is taken for noise");
    field("unknown_share_max", unknown_share_max, Bounds{0.0, 1.0},
          "of a footprint that may be unknown within the map's reach");
  }
};

enum class PathGround {
  kTraversable,    ///< As far as the map reaches.
  kUntraversable,  ///< From `arc_m` on the footprint meets bad ground.
  kUnknown         ///< From `arc_m` on too much of the footprint is unknown within the reach.
};

/// The ground under a path.
struct PathGroundCheck {
  PathGround status = PathGround::kTraversable;
  double arc_m = 0.0;  ///< Of the first pose refused; the path's length if none is.
  GroundClass reason = GroundClass::kTraversable;   ///< Most frequent among the bad cells there.
  Eigen::Vector3d where = Eigen::Vector3d::Zero();  ///< Mean of those cells; z of the pose.
  double radius_m = 0.0;                            ///< Around `where`, to the farthest of them.
  double unknown_share = 0.0;                       ///< The most of any footprint up to `arc_m`.
  double outside_share = 0.0;  ///< The same beyond the map's reach: presumed traversable.
};

/// Puts the robot's rectangle, turned by the yaw, on the path at least every pose_spacing_m, and
/// looks at every cell whose centre lies in it. Stops at the first pose refused. Ground under
/// `standing`, where a robot stands already, counts as traversable. An empty path is traversable.
/// Throws Precondition if a pose is not finite.
[[nodiscard]] PathGroundCheck checkPath(const TerrainView& view, const Path& path,
                                        const FootprintParams& params,
                                        const std::optional<Pose>& standing = std::nullopt);

}  // namespace spelunk::terrain
