#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/local_frame.h"
#include "spelunk/common/params.h"
#include "spelunk/common/scan.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/map/frozen_map.h"
#include "spelunk/map/occupancy.h"

namespace octomap {
class OcTree;
}

namespace spelunk::map {

/// Parameters of the occupancy map (section "map").
struct MapParams {
  double resolution_m = 0.2;
  double range_max_m = 50.0;
  double range_min_m = 0.4;
  double hit_probability = 0.9;
  double miss_probability = 0.45;
  double clamp_min_probability = 0.12;
  double clamp_max_probability = 0.97;
  double occupied_probability = 0.5;
  bool discretize = true;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("resolution_m", resolution_m, Bounds{0.02, 2.0}, "edge of a voxel", Audience::kUser);
    field("range_max_m", range_max_m, Bounds{0.0, 500.0},
          "longer returns only free their ray up to here; 0: as far as the sensors see",
          Audience::kUser);
    field("range_min_m", range_min_m, Bounds{0.0, 10.0}, "nearer returns are dropped");
    field("hit_probability", hit_probability, Bounds{0.5, 1.0}, "occupancy a hit votes for");
    field("miss_probability", miss_probability, Bounds{0.0, 0.5}, "occupancy a miss votes for");
    field("clamp_min_probability", clamp_min_probability, Bounds{0.0, 0.5}, "surest free");
    field("clamp_max_probability", clamp_max_probability, Bounds{0.5, 1.0}, "surest occupied");
    field("occupied_probability", occupied_probability, Bounds{0.0, 1.0}, "above: occupied");
    field("discretize", discretize, Bounds{},
          "one ray a hit voxel, as OctoMap's option of that name");
  }
};

/// Coordinates below it in amount have OctoMap keys, metres; what lies beyond cannot be mapped.
[[nodiscard]] double keyRange(const MapParams& params);

/// What one scan did to the map.
struct MapUpdate {
  int points = 0;
  int dropped_not_finite = 0;
  int dropped_near = 0;
  int dropped_self = 0;
  int dropped_far = 0;  ///< Beyond what OctoMap's keys reach.
  int voxels_updated = 0;
  int voxels_changed_status = 0;
  std::vector<VoxelIndex> newly_occupied;  ///< Voxels that became occupied, in a fixed order.
  AxisAlignedBox changed;  ///< Around all voxels whose status changed; may be empty.
};

/// What to do about points of a scan that no key reaches.
[[nodiscard]] std::string beyondKeysText(const MapUpdate& update, const MapParams& params);

/// Probabilistic occupancy map with the semantics of OctoMap (Hornung et al. 2013): hit and miss
/// log-odds, clamping, occupied wins over free within a scan. Kept as a hash of 8x8x8 blocks; the
/// OcTree is derived from it and identical to what OctoMap itself would hold.
/// One writer; readers use `freeze()`.
class OccupancyMap {
 public:
  explicit OccupancyMap(const MapParams& params);
  ~OccupancyMap();
  OccupancyMap(OccupancyMap&&) noexcept;
  OccupancyMap& operator=(OccupancyMap&&) noexcept;

  /// Enters one scan. Points that are not finite, nearer than range_min_m to the sensor (or in it),
  /// inside `robot_body` (world frame; the robot's own box at the stamp; an empty box for none) or
  /// beyond OctoMap's range (32760 voxels from the world's origin) are dropped and counted. Never
  /// throws on odd points; a scan whose pose is not finite breaks the contract.
  MapUpdate insert(const Scan& scan, const AxisAlignedBox& robot_body);

  /// Marks every voxel the box touches by more than 0.1 mm as free, as one miss would, where it is
  /// unknown (the robot stands there, so it is). Throws Precondition if the box is not finite.
  void markFree(const AxisAlignedBox& box);

  /// From now on takes note of unknown voxels that scans of these sensors look into in vain
  /// (FrozenMap::isSilent): from several places near by, and no ray came back from there. A voxel
  /// that becomes known is none of them any more. Scans are told apart by Scan::sensor. A sensor
  /// that reports misses needs no such notes: its rays make free space where they meet nothing.
  /// `robot_height_m`: rays whose rows are farther apart than that are followed no farther.
  void watchSilence(const std::vector<SensorModel>& sensors, double robot_height_m);

  [[nodiscard]] Occupancy at(const Eigen::Vector3d& point) const;
  [[nodiscard]] const MapParams& params() const;

  /// An immutable view that does not change while scans keep arriving. Cheap: shares the blocks
  /// that did not change since the last call.
  [[nodiscard]] std::shared_ptr<const FrozenMap> freeze();

  /// The same map as an OcTree, brought up to date by the blocks that changed since the last call.
  [[nodiscard]] const octomap::OcTree& octree();

  /// Writes .bt (maximum likelihood) or .ot (full) by the ending, through a temporary file so that
  /// a full disk leaves the old file whole. Keys do not reach far, so the file's coordinates are
  /// this map's; where `frame` is not the caller's own, a comment in the file's header names its
  /// origin. Throws OutsideError with path and reason.
  void save(const std::string& path, const LocalFrame& frame = {});

  /// Replaces the content by a .bt or .ot file. Throws OutsideError if it is missing, not an
  /// octree, or of another resolution; the map is then unchanged.
  void load(const std::string& path);

  /// Writes the silent voxels as the occupied ones of a .bt file; frame and errors as those of
  /// save().
  void saveSilence(const std::string& path, const LocalFrame& frame = {}) const;

  /// Takes up the silent voxels of such a file, those so far kept; errors as those of load().
  void loadSilence(const std::string& path);

  void clear();
  [[nodiscard]] std::size_t memoryBytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::map
