#pragma once

#include "ray_walks.h"
#include "scan_ends.h"

namespace spelunk::map {

/// Lays out the walks of a scan's rays through the voxels OctoMap would update (Hornung et al.,
/// OctoMap, Autonomous Robots 2013, section 5): same arithmetic, so the same voxels bit for bit.
class ScanTracer {
 public:
  explicit ScanTracer(const MapParams& params);

  /// Replaces `walks` by those from `origin` to `ends`. Ends farther off than the map's range are
  /// moved to it and are no hits: that is mended in `marks`. The origin must be within keyLimit.
  void layOut(const Eigen::Vector3f& origin, ScanEnds& ends, ScanMarks& marks, RayWalks& walks);

 private:
  void cutAtRange(const Eigen::Vector3f& origin, ScanEnds& ends, ScanMarks& marks);
  [[nodiscard]] bool isTooFar(std::size_t i) const { return !(norms_[i] <= range_max_m_); }

  double resolution_m_;
  double range_max_m_;
  std::vector<double> norms_;  ///< Lengths of rays; kept, so that no scan allocates.
};

}  // namespace spelunk::map
