#pragma once

#include <optional>
#include <vector>

#include "spelunk/planners/informed/candidates.h"
#include "spelunk/planners/shared/presumed_way.h"

namespace spelunk::planners::informed {

/// Ways towards frontier that was seen from afar: a LiDAR of a few rows sees the end of a gallery,
/// but beside it no place between the rows is free for the robot, so that no sample can be drawn
/// there. Such frontier is approached as far as the way is known; once the robot is near, samples
/// are drawn as ever.
/// Differs from paper: there the sensor reaches no farther than samples are drawn.
class Approaches {
 public:
  /// The piece that can be flown of the way to what promises most for the length of its way; none
  /// if nothing does or no piece of it is 3 m long. `frontier`: places of frontier that was seen
  /// from afar. Where a way turns out closed, none leads again.
  [[nodiscard]] std::optional<Candidate> find(const std::vector<Eigen::Vector3d>& frontier,
                                              const CandidateJudge& judge);

 private:
  struct Target {
    Eigen::Vector3d place;
    double gain_m3;
    double way_m;
  };
  [[nodiscard]] static std::optional<Target> bestOf(const std::vector<Eigen::Vector3d>& frontier,
                                                    const map::PresumedWays& ways,
                                                    const CandidateJudge& judge);

  std::vector<map::ClosedPlace> closed_;
};

}  // namespace spelunk::planners::informed
