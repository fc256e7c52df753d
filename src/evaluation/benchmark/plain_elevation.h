#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "spelunk/common/scan.h"
#include "spelunk/terrain/traversability.h"

namespace spelunk::benchmark {

/// The filter of terrain::ElevationMap cell by cell in a std::map, in doubles: what the fast one is
/// compared with.
class PlainElevation {
 public:
  using Key = std::pair<int, int>;
  struct Cell {
    double height = 0.0;
    double variance = 0.0;
    double other = -1e9;
    int others = 0;
  };

  explicit PlainElevation(const terrain::ElevationParams& params) : params_(params) {}

  void insert(const Scan& scan, const Eigen::Isometry3d& T_world_base);

  [[nodiscard]] const std::map<Key, Cell>& cells() const { return cells_; }

  /// The plane through every cell's window by sums over it: tangents of the slopes.
  [[nodiscard]] std::map<Key, double> slopes(const terrain::TraversabilityParams& params) const;

 private:
  struct High {
    double lowest = 0.0;
    int wait = 1;
    int pause = 1;
  };
  [[nodiscard]] Key keyOf(const Eigen::Vector3d& point) const;
  [[nodiscard]] bool isKept(const Eigen::Vector3d& at, const Eigen::Isometry3d& T) const;
  [[nodiscard]] double climb() const;
  [[nodiscard]] bool hangs(const Key& key, double lowest, const Eigen::Vector3d& base) const;
  void enter(const Key& key, const std::vector<double>& heights, const Eigen::Vector3d& sensor);
  void fuse(double measured, double noise, Cell& cell) const;

  terrain::ElevationParams params_;
  std::map<Key, Cell> cells_;
  std::map<Key, High> high_;  ///< Cells started high above the robot's feet.
  std::optional<Eigen::Vector3d> last_;
  double last_stamp_s_ = 0.0;
};

}  // namespace spelunk::benchmark
