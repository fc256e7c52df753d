#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "ray_fan.h"
#include "spelunk/terrain/elevation_map.h"

namespace spelunk::terrain {

/// Of a cell's returns the highest so far down are averaged: noise and slope within a cell, less
/// than a step.
inline constexpr float kTopBand_m = 0.1F;

/// Where a scan's points lie: x, y from the window's lowest corner, z as in the world. Floats,
/// since the window is small.
struct WindowFrame {
  Eigen::Matrix3f R_window_sensor;
  Eigen::Vector3f sensor;  ///< The sensor's origin.
  Eigen::Vector3f base;    ///< Of the robot.
  Eigen::Isometry3f T_base_window;
  float foot_z = 0.0F;  ///< The robot's ground.
};

/// What a scan says of one cell.
struct CellMeasure {
  int x = 0;  ///< Cell from the window's lowest.
  int y = 0;
  float lowest = 0.0F;  ///< Return.
  float height = 0.0F;  ///< Mean of the highest returns within the clearance.
  int count = 0;        ///< Of those.
};

/// One scan's points sorted into the cells of a window. Keeps its memory from scan to scan.
class ScanCells {
 public:
  ScanCells(const ElevationParams& params, const WindowGrid& grid);

  /// Sorts the points and reduces each cell's to a measure. `heights` are the known cells (NaN
  /// where unknown): what hangs above them by the clearance is dropped.
  void collect(const std::vector<Eigen::Vector3f>& points, const WindowFrame& frame,
               const WindowGrid& grid, const std::vector<float>& heights, ElevationUpdate& update);

  /// In the order the scan first met the cells.
  [[nodiscard]] const std::vector<CellMeasure>& measures() const { return measures_; }
  /// Every ray that goes down, from the sensor.
  [[nodiscard]] const RayFan& rays() const { return rays_; }

 private:
  struct Stack {  ///< The returns in one cell.
    float lowest;
    float highest;
    float sum;
    int count;
  };
  static const Stack kEmpty;
  struct Block;
  void sortBlock(const Eigen::Vector3f* points, std::size_t count, const WindowFrame& frame,
                 ElevationUpdate& update);
  void fill(const Eigen::Vector3f* points, std::size_t count, const WindowFrame& frame,
            Block& block) const;
  /// Whether a point is ground or an obstacle; else it is counted as what it is.
  bool isKept(const Eigen::Vector3f& point, const WindowFrame& frame, ElevationUpdate& update);
  void cutTallStacks(ElevationUpdate& update);
  void measure(const WindowFrame& frame, const WindowGrid& grid, const std::vector<float>& heights,
               ElevationUpdate& update);

  int side_;
  float cell_m_;
  float clearance_m_;
  float climb_;  ///< Rise a metre.
  Eigen::Vector3f half_body_m_;
  std::vector<Stack> stacks_;  ///< By y * side + x; empty between calls.
  std::size_t touched_count_ = 0;
  std::vector<std::uint32_t> touched_;  ///< Stacks in use: the first so many.
  std::vector<char> is_tall_;           ///< By y * side + x; 0 between calls, as the next two.
  std::vector<std::uint32_t> tall_cells_;
  std::vector<std::uint32_t> tall_points_;  ///< Their points, among those below.
  std::size_t used_ = 0;                    ///< Of the two below: the points in the window.
  std::vector<std::uint32_t> cells_;
  std::vector<float> heights_;
  std::vector<CellMeasure> measures_;
  RayFan rays_;
};

}  // namespace spelunk::terrain
