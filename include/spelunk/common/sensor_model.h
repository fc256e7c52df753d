#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/params.h"

namespace spelunk {

enum class SensorKind { kLidar, kDepthCamera };

/// A range sensor as planner and simulator both know it (config/sensors/*.yaml, section
/// "sensor.<name>"). Angles in the files are degrees. x forward, z up in the sensor frame.
struct SensorModel {
  std::string name = "lidar_16";
  std::string kind = "lidar";  ///< "lidar" or "depth_camera"
  double fov_horizontal_deg = 360.0;
  double fov_vertical_deg = 0.0;  ///< Short form: half of it up, half down; 0: the limits tell.
  double fov_lower_deg = 0.0;     ///< Limits of the vertical field above the sensor's own level;
  double fov_upper_deg = 0.0;     ///< both 0: fov_vertical_deg tells. See verticalField().
  int rows = 16;
  int columns = 1800;
  double range_min_m = 0.4;
  double range_max_m = 50.0;
  double rate_hz = 10.0;
  double mapping_period_s = 0.0;  ///< Scans that follow sooner are not mapped; 0 maps all.
  double range_noise_stddev_m = 0.01;
  double dropout_probability = 0.0;
  bool reports_misses = false;  ///< Else a ray that meets nothing in range gives no point.
  Eigen::Vector3d mount_m = Eigen::Vector3d::Zero();  ///< Sensor origin in the base frame.
  double mount_yaw_deg = 0.0;                         ///< About base z first,
  double mount_pitch_deg = 0.0;  ///< then about the turned y (positive looks down),
  double mount_roll_deg = 0.0;   ///< then about the sensor's own x (180: upside down).
  double gain_range_m = 0.0;     ///< Of the rays of a planner's gains; 0: see gainRange().
  double gain_resolution_deg = 5.0;
  double gain_row_angle_deg = 0.0;  ///< Between the rows of those rays; 0: gain_resolution_deg.

  template <class Visitor>
  void visit(Visitor&& field) {
    field("kind", kind, Bounds{}, "lidar or depth_camera");
    field("fov_horizontal_deg", fov_horizontal_deg, Bounds{1.0, 360.0},
          "field of view, horizontal");
    field("fov_vertical_deg", fov_vertical_deg, Bounds{0.0, 180.0},
          "field of view, vertical, half of it up and half down; 0: by the two limits");
    field("fov_lower_deg", fov_lower_deg, Bounds{-90.0, 90.0},
          "lower limit of the vertical field; both limits 0: by fov_vertical_deg");
    field("fov_upper_deg", fov_upper_deg, Bounds{-90.0, 90.0}, "upper limit of the same");
    field("rows", rows, Bounds{1, 4096}, "rays in a column");
    field("columns", columns, Bounds{1, 8192}, "rays in a row");
    field("range_min_m", range_min_m, Bounds{0.0, 100.0}, "shorter returns are dropped");
    field("range_max_m", range_max_m, Bounds{0.5, 500.0}, "the sensor sees no farther");
    field("rate_hz", rate_hz, Bounds{0.1, 100.0}, "scans a second");
    field("mapping_period_s", mapping_period_s, Bounds{0.0, 10.0},
          "least time between scans that enter the map; 0 takes all");
    field("range_noise_stddev_m", range_noise_stddev_m, Bounds{0.0, 1.0}, "noise of a range");
    field("dropout_probability", dropout_probability, Bounds{0.0, 1.0}, "share of lost returns");
    field("reports_misses", reports_misses, Bounds{},
          "rays without return give a point at full range; map.range_max_m must be shorter");
    field("mount_m", mount_m, Bounds{-5.0, 5.0}, "sensor origin in the base frame");
    field("mount_yaw_deg", mount_yaw_deg, Bounds{-180.0, 180.0}, "turn about base z");
    field("mount_pitch_deg", mount_pitch_deg, Bounds{-180.0, 180.0}, "then about y; + looks down");
    field("mount_roll_deg", mount_roll_deg, Bounds{-180.0, 180.0},
          "then about the sensor's own x; 180: upside down");
    field("gain_range_m", gain_range_m, Bounds{0.0, 500.0},
          "range of the rays of a gain; 0: as far as sensor and map see");
    field("gain_resolution_deg", gain_resolution_deg, Bounds{0.5, 45.0},
          "angle between the rays of a gain");
    field("gain_row_angle_deg", gain_row_angle_deg, Bounds{0.0, 45.0},
          "the same between rows; 0: no other");
  }
  [[nodiscard]] std::vector<std::string> problems() const;
};

[[nodiscard]] SensorKind kindOf(const SensorModel& sensor);

/// Limits above the sensor's own level, degrees.
struct VerticalField {
  double lower_deg = -15.0;
  double upper_deg = 15.0;

  [[nodiscard]] double width() const { return upper_deg - lower_deg; }
  [[nodiscard]] double middle() const { return 0.5 * (lower_deg + upper_deg); }
};

/// The vertical field of view: by the limits where there are some, else by fov_vertical_deg, else
/// that of a VerticalField{}.
[[nodiscard]] VerticalField verticalField(const SensorModel& sensor);

/// The range of the rays of gains, metres: gain_range_m, or all of range_max_m where that is 0.
[[nodiscard]] double gainRange(const SensorModel& sensor);

/// Whether what the sensor sees from a place does not depend on the robot's heading: its columns
/// go round a vertical axis, or it is tilted by no more than its field has room for above and below
/// the horizon.
[[nodiscard]] bool seesAllAround(const SensorModel& sensor);

/// Volume that one look into the open shows, m3: the field of view up to gainRange(). A field
/// flatter than the rays of a gain are apart counts as high as these are.
[[nodiscard]] double lookVolume(const SensorModel& sensor);

/// The sensor with every value that follows from another one written out, for a map that takes
/// returns up to `map_range_m`.
[[nodiscard]] SensorModel resolved(SensorModel sensor, double map_range_m);

/// Up to which distance neighbouring rows of rays are at most `gap_m` apart, metres; not beyond the
/// range of the sensor's gains.
[[nodiscard]] double denseRange(const SensorModel& sensor, double gap_m);

/// Which scans of one sensor enter the map: those at least SensorModel::mapping_period_s after the
/// last that did, and those of a clock that jumped back.
class ScanThinning {
 public:
  explicit ScanThinning(double mapping_period_s) : period_s_(mapping_period_s) {}

  /// Whether a scan with this stamp is mapped; if so, it is the last one that was.
  [[nodiscard]] bool takes(double stamp_s);

 private:
  double period_s_;
  std::optional<double> last_s_;
};

/// Base from sensor: mount_m and R_z(yaw) * R_y(pitch) * R_x(roll).
[[nodiscard]] Eigen::Isometry3d T_base_sensor(const SensorModel& sensor);

/// Unit directions of all rays in the sensor frame, row by row from the lowest, each row over the
/// columns; a lidar's columns divide the horizontal field evenly (a full circle without repeating
/// its first column), a depth camera's pixels lie evenly on its image plane.
[[nodiscard]] std::vector<Eigen::Vector3f> rayDirections(const SensorModel& sensor);

}  // namespace spelunk
