#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "block_map.h"
#include "spelunk/common/scan.h"
#include "spelunk/common/sensor_model.h"

namespace spelunk::map {

/// Directions of one sensor in cells of about equal angle: the faces of a cube around it, each a
/// grid. Needs no angles, so thousands of returns are sorted into cells cheaply.
class DirectionCells {
 public:
  /// `angle`: of a cell in the middle of a face, radians; cells towards the corners are smaller.
  explicit DirectionCells(double angle);

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(6 * side_ * side_); }

  /// The cell of a direction of any length; none for one without length or that is not finite.
  [[nodiscard]] std::optional<std::size_t> cellOf(const Eigen::Vector3f& direction) const {
    const float x = std::fabs(direction.x());
    const float y = std::fabs(direction.y());
    const float z = std::fabs(direction.z());
    const float sum = x + y + z;
    if (!(sum > 0.0F && sum < std::numeric_limits<float>::infinity())) return std::nullopt;
    if (x >= y && x >= z) return cellOn(0, direction.x(), direction.y(), direction.z());
    if (y >= z) return cellOn(2, direction.y(), direction.z(), direction.x());
    return cellOn(4, direction.z(), direction.x(), direction.y());
  }

 private:
  [[nodiscard]] std::size_t cellOn(int face, float along, float u, float v) const {
    const float half = 0.5F * static_cast<float>(side_);
    const float scale = half / std::fabs(along);
    const int column = std::min(side_ - 1, static_cast<int>(u * scale + half));
    const int row = std::min(side_ - 1, static_cast<int>(v * scale + half));
    return static_cast<std::size_t>(((face + (along < 0.0F ? 1 : 0)) * side_ + column) * side_ +
                                    row);
  }

  int side_;
};

/// Tells from the scans of one sensor where it looks into unknown space and gets nothing back.
///
/// A look is a scan from a new place. The sensor's own rays, one a cell of direction, are followed
/// from the sensor through the map: those in whose cell the scan has no return, up to rock and no
/// farther than range(). A ray is sure of what it passed through only as far as neighbouring rays
/// leave nothing of the robot's size between them. And where a gallery goes on beyond the sensor's
/// reach, rays along it return nothing either: at distance d their part of its width is d over the
/// reach, so that at most a quarter of the reach is taken.
class SilenceWatch {
 public:
  /// `gap_m`: what may lie between two rows of rays without being passed by; the robot's height.
  SilenceWatch(const SensorModel& sensor, double gap_m, double resolution_m);

  /// How far rays are followed, metres.
  [[nodiscard]] double range() const { return range_m_; }
  /// A scan from nearer to the last look is none: rays would go the same ways again.
  [[nodiscard]] double spacing() const { return 0.1 * range_m_; }

  /// Whether a scan is a look; if so, it is the last one.
  [[nodiscard]] bool takes(const Scan& scan);

  /// The map is another one now: the next scan is a look wherever it is from.
  void forget() { last_place_.reset(); }

  /// Unknown voxels on rays of `scan` that return nothing, behind free space; some repeatedly. Of
  /// a run of unknown voxels only the first kDepth: what gains ask for.
  [[nodiscard]] std::vector<PackedKey> voxelsLookedInto(const Scan& scan, const BlockMap& map);

  static constexpr int kDepth = 7;  ///< Voxels.

 private:
  struct Ray {
    Eigen::Vector3d direction;  ///< Sensor frame.
    std::size_t cell;
  };
  void noteReturns(const Scan& scan);
  void follow(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, const BlockMap& map,
              std::vector<PackedKey>& looked_into) const;

  double range_m_;
  double resolution_m_;
  DirectionCells cells_;
  std::vector<Ray> rays_;
  std::vector<char> has_return_;  ///< By cell; of the scan at hand.
  std::optional<Eigen::Vector3d> last_place_;
};

}  // namespace spelunk::map
