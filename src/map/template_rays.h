#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "spelunk/common/sensor_model.h"
#include "spelunk/map/occupancy.h"

namespace spelunk::map {

/// The rays of one sensor as voxel offsets from the centre of the voxel around its origin, nearest
/// first; that voxel itself is left out. Each ray holds the voxels it enters before the sensor's
/// gain range. Directions are rounded to 2^-24, so that the lists are the same on every machine.
class TemplateRays {
 public:
  using Step = std::array<std::int16_t, 3>;
  struct Ray {
    std::uint32_t begin;
    std::uint32_t end;
    Step last;                                 ///< The step before `end`.
    std::array<std::uint32_t, 3> crossings{};  ///< Where `crossings_` of each axis begin.
    std::uint32_t cone = 0;                    ///< Where the ray begins in `coneVolumes()`.
  };
  /// Closed range of offsets.
  struct Range {
    VoxelIndex first;
    VoxelIndex last;

    [[nodiscard]] bool contains(const VoxelIndex& offset) const {
      return (offset.array() >= first.array()).all() && (offset.array() <= last.array()).all();
    }
  };
  /// Rays of one heading: `count` rays of `rays()` from `first` on, around its end.
  struct Heading {
    std::size_t first;
    std::size_t count;
  };

  TemplateRays(const SensorModel& sensor, double resolution_m);

  /// Rays at the base's `yaw`, rounded to the nearest of the headings kept: multiples of the angle
  /// between rays for a sensor whose axis is vertical, at least that for a tilted one.
  [[nodiscard]] Heading headingAt(double yaw) const;
  /// Whether the rays are the same at every heading.
  [[nodiscard]] bool isSameAtAllHeadings() const {
    return is_upright_ && columns_ == circle_columns_;
  }
  /// How far the rays reach up and down, metres from the voxel's centre; neither is negative.
  [[nodiscard]] double reachUp() const { return reach_up_m_; }
  [[nodiscard]] double reachDown() const { return reach_down_m_; }
  /// Number of steps before the ray leaves `range`, which must contain offset 0. A ray leaves a box
  /// once, so these are all of its steps inside.
  [[nodiscard]] std::size_t stepsInside(const Ray& ray, const Range& range) const {
    std::size_t count = ray.end - ray.begin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int last = ray.last[axis];
      const auto i = static_cast<int>(axis);
      const int allowed = last < 0 ? -range.first(i) : range.last(i);
      if ((last < 0 ? -last : last) <= allowed) continue;
      const std::size_t crossing = ray.crossings[axis] + static_cast<std::size_t>(allowed);
      count = std::min<std::size_t>(count, crossings_[crossing]);
    }
    return count;
  }
  [[nodiscard]] const std::vector<Ray>& rays() const { return rays_; }
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  /// Rays of one azimuth, which follow each other in `rays()`.
  [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(rows_); }
  /// For each step of a ray and for its end: the part of the ray's share of the field of view that
  /// lies nearer, in volumes of a voxel. What differs between two is the volume they hold.
  [[nodiscard]] const std::vector<float>& coneVolumes() const { return cone_volumes_; }
  /// The lengths that these volumes belong to, in voxels.
  [[nodiscard]] const std::vector<float>& coneLengths() const { return cone_lengths_; }
  [[nodiscard]] const Eigen::Vector3d& mount() const { return mount_m_; }

 private:
  /// A row of the sensor sees a solid angle that shrinks towards the poles.
  void addRay(const Eigen::Vector3d& direction, double solid_angle, double range_voxels);
  [[nodiscard]] double solidAngleOf(int row) const;
  void addCrossings(Ray& ray);
  void divideField(const SensorModel& sensor, double angle_factor);
  void makeRoomForHeadings(const SensorModel& sensor, double range_voxels);
  void addUprightCircle(double range_voxels);
  void addTiltedHeadings(double range_voxels);
  void measureHeight(double resolution_m);
  [[nodiscard]] double elevationOf(int row) const;

  Eigen::Vector3d mount_m_;
  Eigen::Matrix3d R_base_sensor_;
  double mount_yaw_ = 0.0;
  double field_middle_ = 0.0;  ///< Elevation in the sensor frame, radians.
  double fov_vertical_ = 0.0;
  double spacing_ = 0.0;  ///< Between columns, radians; divides the circle.
  int circle_columns_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  int headings_ = 1;        ///< Of a tilted sensor; an upright one turns by columns.
  bool is_upright_ = true;  ///< Its axis is vertical, whichever end is up.
  double reach_up_m_ = 0.0;
  double reach_down_m_ = 0.0;
  std::vector<Ray> rays_;
  std::vector<Step> steps_;
  std::vector<float> cone_volumes_;
  std::vector<float> cone_lengths_;
  std::vector<std::uint16_t> crossings_;  ///< By ray, axis, k: steps before the offset exceeds k.
};

}  // namespace spelunk::map
