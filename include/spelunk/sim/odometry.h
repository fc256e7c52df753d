#pragma once

#include <Eigen/Geometry>

#include "spelunk/common/rng.h"
#include "spelunk/sim/flight_controller.h"

namespace spelunk::sim {

/// Dead reckoning: position and heading wander from the truth as a random walk over the distance
/// flown; the reported position carries white noise on top. Without either it is the truth,
/// exactly.
class Odometry {
 public:
  /// `drift` is metres (1 sigma) after one metre; the heading drifts a tenth of that, in radians.
  Odometry(double drift, double noise_m, const BodyState& start, const Rng& rng);

  /// From now on poses are reported that differ from the ones before: moved by `by` metres here,
  /// and turned about the robot. What lies behind is not told again, as with the loop closures of a
  /// SLAM.
  void correct(const Eigen::Vector3d& by, double yaw_rad);

  /// The body moved to `truth`.
  void advance(const BodyState& truth);

  /// What the state estimator believes: drifted, but smooth. The controller flies on this.
  [[nodiscard]] BodyState estimate() const { return estimate_; }

  /// The estimate with this instant's white noise; the same until the next `advance`.
  [[nodiscard]] BodyState measurement() const;

 private:
  double drift_;
  double noise_m_;
  Rng drift_rng_;
  Rng noise_rng_;
  BodyState truth_;
  BodyState estimate_;
  Eigen::Vector3d noise_ = Eigen::Vector3d::Zero();
  double yaw_drift_rad_ = 0.0;
  bool is_truth_ = true;  ///< As long as nothing was added to it.
};

}  // namespace spelunk::sim
