#include "spelunk/terrain/terrain_map.h"

#include "spelunk/common/contract.h"

namespace spelunk::terrain {
namespace {

/// The window must hold the neighbours of the outermost cells that are asked for.
ElevationParams withMargin(const TerrainParams& params) {
  require(params.problems().empty(), "TerrainMap: the parameters contradict each other");
  ElevationParams wider = params.elevation;
  wider.reach_m += wider.cell_m * Traversability::marginOf(params.traversability, wider.cell_m);
  return wider;
}

}  // namespace

std::vector<std::string> TerrainParams::problems() const {
  std::vector<std::string> problems = elevation.problems();
  for (const std::string& problem : traversability.problems()) problems.push_back(problem);
  return problems;
}

TerrainMap::TerrainMap(const TerrainParams& params)
    : params_(params),
      elevation_(withMargin(params)),
      traversability_(params.traversability, elevation_.grid()) {}

ElevationUpdate TerrainMap::insert(const Scan& scan, const Eigen::Isometry3d& T_world_base) {
  const ElevationUpdate update = elevation_.insert(scan, T_world_base);
  if (update.verdict == ScanVerdict::kRefused) return update;
  traversability_.note(elevation_);
  view_ = nullptr;
  return update;
}

void TerrainMap::assumeGroundUnder(const Eigen::Isometry3d& T_world_base) {
  elevation_.assumeGroundUnder(T_world_base);
  traversability_.note(elevation_);
  view_ = nullptr;
}

std::shared_ptr<const TerrainView> TerrainMap::freeze() {
  if (view_ != nullptr) return view_;
  traversability_.update(elevation_);
  view_ = std::make_shared<const TerrainView>(elevation_, traversability_);
  return view_;
}

PathGroundCheck TerrainMap::checkPath(const Path& path, const std::optional<Pose>& standing) {
  return terrain::checkPath(*freeze(), path, params_.footprint, standing);
}

void TerrainMap::clear() { *this = TerrainMap(params_); }

}  // namespace spelunk::terrain
