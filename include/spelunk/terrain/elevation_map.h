#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/scan.h"
#include "spelunk/terrain/window_grid.h"

namespace spelunk::terrain {

/// Parameters of the elevation map (section "terrain").
struct ElevationParams {
  double cell_m = 0.04;
  double reach_m = 4.0;
  double base_height_m = 0.5;
  double clearance_m = 1.0;
  Eigen::Vector3d body_m{1.2, 0.85, 0.7};
  double climb_deg = 25.0;
  double noise_base_m = 0.01;
  double noise_quadratic_1pm = 0.002;
  double gate_sigmas = 3.0;
  int conflicts_to_replace = 3;
  double growth_m2_per_m = 1e-4;
  double growth_m2_per_s = 1e-5;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("cell_m", cell_m, Bounds{0.01, 0.5}, "edge of a cell", Audience::kUser);
    field("reach_m", reach_m, Bounds{0.5, 20.0}, "from the robot to the map's edge",
          Audience::kUser);
    field("base_height_m", base_height_m, Bounds{0.0, 3.0},
          "of the base above the ground when standing; 0: robot.ride_height_m", Audience::kUser);
    field("clearance_m", clearance_m, Bounds{0.1, 10.0},
          "what hangs higher above the ground is no obstacle", Audience::kUser);
    field("body_m", body_m, Bounds{0.0, 10.0},
          "length, width, height around the base: returns inside are the robot's own; "
          "left out: robot.box_m");
    field(
        "climb_deg", climb_deg, Bounds{0.0, 60.0},
        "ground rises at most so much from the robot; what is higher by the clearance is ceiling");
    field("noise_base_m", noise_base_m, Bounds{1e-4, 1.0}, "deviation of a height at range 0");
    field("noise_quadratic_1pm", noise_quadratic_1pm, Bounds{0.0, 1.0},
          "its increase with the square of the range");
    field("gate_sigmas", gate_sigmas, Bounds{1.0, 10.0},
          "Mahalanobis distance beyond which a height is in conflict with its cell");
    field("conflicts_to_replace", conflicts_to_replace, Bounds{1, 50},
          "scans that agree with each other, but not with the cell, until they replace it");
    field("growth_m2_per_m", growth_m2_per_m, Bounds{0.0, 1.0},
          "variance gained a metre the robot moves");
    field("growth_m2_per_s", growth_m2_per_s, Bounds{0.0, 1.0},
          "variance gained a second the robot moves");
  }
  [[nodiscard]] std::vector<std::string> problems() const;
};

enum class ScanVerdict {
  kUsed,
  kEmpty,    ///< No usable point; the map moved with the robot, nothing else changed.
  kRefused,  ///< A pose is not finite, not a rigid motion, or the sensor is out of the window.
};

/// What one scan did to the map.
struct ElevationUpdate {
  ScanVerdict verdict = ScanVerdict::kUsed;
  int points = 0;
  int dropped_not_finite = 0;
  int dropped_self = 0;     ///< Inside the robot's own body.
  int dropped_outside = 0;  ///< Beyond the window (their rays still count against drops).
  int dropped_high = 0;     ///< Ceilings and overhangs.
  int cells_started = 0;    ///< Seen for the first time, or replaced after repeated conflict.
  int cells_fused = 0;
  int cells_in_conflict = 0;
};

/// Height and uncertainty of a known cell, metres.
struct ElevationCell {
  double height_m = 0.0;
  double variance_m2 = 0.0;
  double stamp_s = 0.0;  ///< Of the last scan that agreed with the cell.
};

class ScanCells;
struct CellMeasure;

/// Robot-centric height of the ground with its variance, fused from all sensors (the idea of
/// Fankhauser et al., Robot-centric elevation mapping with uncertainty estimates, CLAWAR 2014;
/// Dang 2020, section 4.3).
///
/// A scan is reduced to one measurement a cell: from the lowest return on, everything within
/// `clearance_m` is ground or what stands on it, and what hangs higher is dropped (in place of the
/// lowest local maximum of Miller 2020, section V-A1: a wall's cell must not take the wall's foot
/// for ground). Where no ground is known, the robot's own and all that is known on the way to it
/// tell with `climb_deg` what is too high; a cell taken for ground before the ground on that way
/// was seen is forgotten when it is. The highest 10 cm of the rest are averaged: the surface a foot
/// would meet. The measurement enters a Kalman filter unless its Mahalanobis distance is too large;
/// measurements that keep disagreeing with the cell, but agree with each other, replace it.
///
/// Besides, every ray that goes down tells how high the surface below it can be at most, which is
/// kept for cells not seen yet: it is how a hole is known whose bottom nobody sees. Rays are
/// gathered by direction (512 sectors) and by the distance of their ends (a cell's width). Not
/// thread-safe.
class ElevationMap {
 public:
  /// Throws Precondition if the window is impossible (see WindowGrid).
  explicit ElevationMap(const ElevationParams& params);
  ~ElevationMap();
  ElevationMap(ElevationMap&&) noexcept;
  ElevationMap& operator=(ElevationMap&&) noexcept;

  /// Moves the window to the robot, lets uncertainty grow and enters the scan. Odd points are
  /// dropped and counted; odd poses make the scan be refused, the map then is unchanged.
  ElevationUpdate insert(const Scan& scan, const Eigen::Isometry3d& T_world_base);

  /// Takes the ground under the robot's body as it must be for the robot to stand there, where no
  /// sensor has seen it. Throws Precondition if the pose is not finite.
  void assumeGroundUnder(const Eigen::Isometry3d& T_world_base);

  [[nodiscard]] const ElevationParams& params() const { return params_; }
  [[nodiscard]] const WindowGrid& grid() const { return grid_; }
  /// What is known of a cell; nothing outside the window or if never seen.
  [[nodiscard]] std::optional<ElevationCell> at(const CellIndex& cell) const;
  /// Height minus/plus `sigmas` standard deviations.
  [[nodiscard]] std::optional<double> lowerBound(const CellIndex& cell, double sigmas) const;
  [[nodiscard]] std::optional<double> upperBound(const CellIndex& cell, double sigmas) const;
  /// The lowest height at which a ray passed over the cell; nothing if none did, or if the cell was
  /// known by then.
  [[nodiscard]] std::optional<double> rayBound(const CellIndex& cell) const;
  /// Where the robot's ground is by its own pose, z.
  [[nodiscard]] double footHeight() const { return foot_z_; }

  /// Layers by slot of grid(): heights (NaN where unknown) and ray bounds (infinite where none).
  [[nodiscard]] const std::vector<float>& heights() const { return height_; }
  [[nodiscard]] const std::vector<float>& variances() const { return variance_; }
  [[nodiscard]] const std::vector<float>& rayBounds() const { return bound_; }
  /// Cells whose height or ray bound changed in the last call that changed the map.
  [[nodiscard]] const std::vector<CellIndex>& changed() const { return changed_; }
  /// Whether that call changed the ray bounds of the whole map.
  [[nodiscard]] bool changedEverywhere() const { return changed_everywhere_; }

 private:
  void moveWindow(const CellIndex& middle);
  void forget(const CellIndex& first, const CellIndex& end);
  void growUncertainty(const Eigen::Vector3d& position, double stamp_s);
  /// A cell that was started high above the robot's feet. Most are walls and stay: the longer they
  /// do, the less often they are looked at.
  struct HighCell {
    CellIndex cell;
    float lowest;  ///< Return.
    int wait;      ///< Scans until the next look.
    int pause;     ///< Between the last two.
  };
  [[nodiscard]] bool hangs(const CellMeasure& measure) const;
  [[nodiscard]] bool hangs(const CellIndex& cell, float lowest) const;
  void forgetHanging();
  void start(std::size_t slot, float height, float variance);
  void fuse(const CellMeasure& measure, const Eigen::Vector3f& sensor, float stamp,
            ElevationUpdate& update);
  /// Whether the cell now agrees with the measurement.
  bool correct(std::size_t slot, float measured, float noise, ElevationUpdate& update);
  void fuseCells(const Eigen::Vector3f& sensor, float stamp, ElevationUpdate& update);
  void lowerBounds(const Eigen::Vector3f& sensor);

  ElevationParams params_;
  WindowGrid grid_;
  std::vector<float> height_;
  std::vector<float> variance_;
  std::vector<float> stamp_;  ///< Seconds since `first_stamp_s_`.
  std::vector<float> bound_;
  std::vector<float> other_height_;  ///< Of the measurements in conflict with the cell.
  std::vector<std::uint8_t> other_count_;
  std::vector<HighCell> high_cells_;
  std::vector<CellIndex> changed_;
  bool changed_everywhere_ = false;
  float pending_drift_m_ = 0.0F;  ///< Not yet added to the bounds.
  std::optional<Eigen::Vector3d> last_position_;
  double first_stamp_s_ = 0.0;
  double last_stamp_s_ = 0.0;
  double foot_z_ = 0.0;
  std::unique_ptr<ScanCells> scan_cells_;  ///< Working memory of insert.
};

}  // namespace spelunk::terrain
