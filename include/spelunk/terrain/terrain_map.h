#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/terrain/elevation_map.h"
#include "spelunk/terrain/footprint.h"
#include "spelunk/terrain/terrain_view.h"
#include "spelunk/terrain/traversability.h"

namespace spelunk::terrain {

/// Parameters of the terrain map (section "terrain").
struct TerrainParams {
  ElevationParams elevation;
  TraversabilityParams traversability;
  FootprintParams footprint;

  template <class Visitor>
  void visit(Visitor&& field) {
    elevation.visit(field);
    traversability.visit(field);
    footprint.visit(field);
  }
  [[nodiscard]] std::vector<std::string> problems() const;
};

/// The ground around a walking robot: elevation, traversability and the check of paths.
/// One writer; readers use freeze().
class TerrainMap {
 public:
  /// Throws Precondition if the parameters contradict each other (see problems()).
  explicit TerrainMap(const TerrainParams& params);

  /// Enters one scan of any sensor, taken while the base was at `T_world_base`. See ElevationMap.
  ElevationUpdate insert(const Scan& scan, const Eigen::Isometry3d& T_world_base);

  /// Where the robot stands is ground, seen or not: for the start, and for robots without a camera.
  void assumeGroundUnder(const Eigen::Isometry3d& T_world_base);

  /// An immutable view with the traversability brought up to date; the same one until the map
  /// changes.
  [[nodiscard]] std::shared_ptr<const TerrainView> freeze();
  [[nodiscard]] PathGroundCheck checkPath(const Path& path,
                                          const std::optional<Pose>& standing = std::nullopt);
  [[nodiscard]] std::optional<double> groundHeight(const Eigen::Vector2d& xy) {
    return freeze()->groundHeight(xy);
  }

  [[nodiscard]] const TerrainParams& params() const { return params_; }
  [[nodiscard]] const ElevationMap& elevation() const { return elevation_; }
  /// As of the last freeze().
  [[nodiscard]] const Traversability& traversability() const { return traversability_; }
  void clear();

 private:
  TerrainParams params_;
  ElevationMap elevation_;
  Traversability traversability_;
  std::shared_ptr<const TerrainView> view_;  ///< Of the map as it is; empty if not made.
};

}  // namespace spelunk::terrain
