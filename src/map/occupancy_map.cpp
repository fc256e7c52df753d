#include "spelunk/map/occupancy_map.h"

#include <cmath>
#include <cstdio>
#include <map>

#include "block_map.h"
#include "frozen_blocks.h"
#include "octree_file.h"
#include "octree_mirror.h"
#include "scan_tracer.h"
#include "silence_watch.h"
#include "silent_voxels.h"
#include "spelunk/common/contract.h"
#include "voxel_key.h"

namespace spelunk::map {
namespace {

constexpr double kFaceTolerance = 1e-4;  // a box does not touch what it overlaps by less, metres

}  // namespace

double keyRange(const MapParams& params) { return keyLimit(params.resolution_m); }

std::string beyondKeysText(const MapUpdate& update, const MapParams& params) {
  char text[250];
  std::snprintf(text, sizeof text,
                "%d points of a scan lie more than %.0f m from the map's origin and cannot be "
                "mapped: voxels of %.2f m have no keys there; raise map.resolution_m, or begin the "
                "mission nearer to where it explores",
                update.dropped_far, keyRange(params), params.resolution_m);
  return text;
}

struct OccupancyMap::Impl {
  explicit Impl(const MapParams& map_params)
      : params(map_params), blocks(LogOdds(map_params)), points(map_params), tracer(map_params) {}

  void forget() {
    blocks = BlockMap(LogOdds(params));
    silence = {};
    for (auto& [sensor, watch] : watches) watch.forget();
    frozen = nullptr;
    tree = nullptr;
  }

  /// The watch of the sensor a scan is of; nullptr if there is none.
  [[nodiscard]] SilenceWatch* watchOf(const Scan& scan) {
    const auto found = watches.find(scan.sensor);
    return found == watches.end() ? nullptr : &found->second;
  }

  MapParams params;
  BlockMap blocks;
  SilentVoxels silence;
  std::map<std::string, SilenceWatch> watches;  ///< By sensor.
  ScanPoints points;
  ScanTracer tracer;
  RayMarker marker;
  ScanMarks marks;  ///< These three are of the scan at hand; kept, so that no scan allocates.
  ScanEnds ends;
  RayWalks walks;
  std::shared_ptr<const FrozenMap> frozen;
  std::unique_ptr<OcTreeMirror> tree;
};

OccupancyMap::OccupancyMap(const MapParams& params) {
  require(std::isfinite(params.resolution_m) && params.resolution_m > 0.0,
          "OccupancyMap: resolution must be positive");
  impl_ = std::make_unique<Impl>(params);
}
OccupancyMap::~OccupancyMap() = default;
OccupancyMap::OccupancyMap(OccupancyMap&&) noexcept = default;
OccupancyMap& OccupancyMap::operator=(OccupancyMap&&) noexcept = default;

MapUpdate OccupancyMap::insert(const Scan& scan, const AxisAlignedBox& robot_body) {
  require(scan.T_world_sensor.matrix().allFinite(), "OccupancyMap: sensor pose is not finite");
  MapUpdate update;
  update.points = static_cast<int>(scan.points.size());
  impl_->marks.clear();
  impl_->points.findEnds(scan, robot_body, impl_->marks, impl_->ends, update);
  if (impl_->ends.count > 0) {
    const Eigen::Vector3f origin = scan.T_world_sensor.translation().cast<float>();
    impl_->tracer.layOut(origin, impl_->ends, impl_->marks, impl_->walks);
    impl_->marker.markFree(impl_->walks, impl_->marks);
  }
  impl_->blocks.apply(impl_->marks, impl_->params.resolution_m, update);
  SilenceWatch* watch = impl_->watchOf(scan);
  if (watch != nullptr && watch->takes(scan))
    impl_->silence.countLook(watch->voxelsLookedInto(scan, impl_->blocks));
  return update;
}

void OccupancyMap::watchSilence(const std::vector<SensorModel>& sensors, double robot_height_m) {
  require(robot_height_m > 0.0, "OccupancyMap: the robot's height must be positive");
  impl_->watches.clear();
  for (const SensorModel& sensor : sensors)
    if (!sensor.reports_misses)
      impl_->watches.emplace(sensor.name,
                             SilenceWatch(sensor, robot_height_m, impl_->params.resolution_m));
}

void OccupancyMap::markFree(const AxisAlignedBox& box) {
  require(box.min.allFinite() && box.max.allFinite(), "OccupancyMap: box is not finite");
  const double inverse_resolution = 1.0 / impl_->params.resolution_m;
  const VoxelIndex low = VoxelIndex::Constant(-kKeyOffset);
  const VoxelIndex high = VoxelIndex::Constant(kKeyOffset - 1);
  const VoxelIndex first =
      voxelOf(box.min.array() + kFaceTolerance, inverse_resolution).cwiseMax(low);
  const VoxelIndex last =
      voxelOf(box.max.array() - kFaceTolerance, inverse_resolution).cwiseMin(high);
  const LogOdds& log_odds = impl_->blocks.logOdds();
  const float value = log_odds.miss < log_odds.occupied ? log_odds.miss : log_odds.clamp_min;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const VoxelIndex index(x, y, z);
        if (impl_->blocks.at(index) == Occupancy::kUnknown)
          impl_->blocks.setValue(packIndex(index), value);
      }
}

Occupancy OccupancyMap::at(const Eigen::Vector3d& point) const {
  return impl_->blocks.at(voxelOf(point, 1.0 / impl_->params.resolution_m));
}

const MapParams& OccupancyMap::params() const { return impl_->params; }

std::shared_ptr<const FrozenMap> OccupancyMap::freeze() {
  const MapChanges changed{impl_->blocks.takeStatusChanges(), impl_->silence.takeChanges()};
  if (impl_->frozen != nullptr && changed.empty()) return impl_->frozen;
  const FrozenMap::Blocks nothing;
  const FrozenMap::Blocks& last = impl_->frozen ? impl_->frozen->blocks() : nothing;
  impl_->frozen = std::make_shared<const FrozenMap>(
      freezeBlocks(impl_->blocks, impl_->silence, changed, last), impl_->params.resolution_m);
  return impl_->frozen;
}

const octomap::OcTree& OccupancyMap::octree() {
  if (impl_->tree == nullptr) impl_->tree = std::make_unique<OcTreeMirror>(impl_->params);
  impl_->blocks.takeTreeChanges([&](const VoxelBlock& block) { impl_->tree->update(block); });
  return *impl_->tree;
}

void OccupancyMap::save(const std::string& path, const LocalFrame& frame) {
  if (octreeFormatOf(path) == OctreeFormat::kFull) {
    writeOctree(octree(), OctreeFormat::kFull, path, frame);
    return;
  }
  OcTreeMirror likely(impl_->params);
  for (std::size_t i = 0; i < impl_->blocks.blockCount(); ++i)
    likely.updateMaximumLikelihood(impl_->blocks.block(i));
  writeOctree(likely, OctreeFormat::kMaximumLikelihood, path, frame);
}

void OccupancyMap::load(const std::string& path) {
  BlockMap loaded(impl_->blocks.logOdds());
  readOctree(path, impl_->params.resolution_m, loaded);
  impl_->forget();
  impl_->blocks = std::move(loaded);
}

void OccupancyMap::saveSilence(const std::string& path, const LocalFrame& frame) const {
  const MapParams& params = impl_->params;
  BlockMap silent{LogOdds(params)};
  for (const PackedKey voxel : impl_->silence.all())
    silent.setValue(voxel, silent.logOdds().clamp_max);
  OcTreeMirror tree(params);
  for (std::size_t i = 0; i < silent.blockCount(); ++i)
    tree.updateMaximumLikelihood(silent.block(i));
  writeOctree(tree, octreeFormatOf(path), path, frame);
}

void OccupancyMap::loadSilence(const std::string& path) {
  BlockMap loaded{LogOdds(impl_->params)};
  readOctree(path, impl_->params.resolution_m, loaded);
  std::vector<PackedKey> silent;
  for (std::size_t i = 0; i < loaded.blockCount(); ++i) {
    const VoxelBlock& block = loaded.block(i);
    forEachVoxel(block.occupied, [&](const VoxelIndex& in_block) {
      silent.push_back(block.key + packKey(in_block.x(), in_block.y(), in_block.z()));
    });
  }
  for (int look = 0; look < SilentVoxels::kLooks; ++look) impl_->silence.countLook(silent);
}

void OccupancyMap::clear() { impl_->forget(); }

std::size_t OccupancyMap::memoryBytes() const {
  return impl_->blocks.memoryBytes() + impl_->silence.memoryBytes();
}

}  // namespace spelunk::map
