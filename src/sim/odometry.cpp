#include "spelunk/sim/odometry.h"

#include <cmath>

namespace spelunk::sim {
namespace {

constexpr double kYawDriftShare = 0.1;  ///< rad of heading per metre of position drift.

Eigen::Vector3d normals(Rng& rng) {
  const double x = rng.normal();
  const double y = rng.normal();
  return {x, y, rng.normal()};
}

}  // namespace

Odometry::Odometry(double drift, double noise_m, const BodyState& start, const Rng& rng)
    : drift_(drift),
      noise_m_(noise_m),
      drift_rng_(rng.fork("drift")),
      noise_rng_(rng.fork("noise")),
      truth_(start),
      estimate_(start) {}

void Odometry::advance(const BodyState& truth) {
  if (noise_m_ > 0.0) noise_ = noise_m_ * normals(noise_rng_);
  if (drift_ <= 0.0 && is_truth_) {
    estimate_ = truth_ = truth;
    return;
  }
  const Eigen::Vector3d moved = truth.position - truth_.position;
  const double sigma = drift_ * std::sqrt(moved.norm());
  if (drift_ > 0.0) yaw_drift_rad_ += kYawDriftShare * sigma * drift_rng_.normal();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw_drift_rad_, Eigen::Vector3d::UnitZ()));
  estimate_.position += turn * moved;
  if (drift_ > 0.0) estimate_.position += sigma / std::sqrt(3.0) * normals(drift_rng_);
  estimate_.orientation = (turn * truth.orientation).normalized();
  estimate_.velocity = turn * truth.velocity;
  estimate_.angular_velocity = truth.angular_velocity;
  truth_ = truth;
}

void Odometry::correct(const Eigen::Vector3d& by, double yaw_rad) {
  const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
  is_truth_ = false;
  yaw_drift_rad_ += yaw_rad;
  estimate_.position += by;
  estimate_.orientation = (turn * estimate_.orientation).normalized();
  estimate_.velocity = turn * estimate_.velocity;
}

BodyState Odometry::measurement() const {
  BodyState measured = estimate_;
  measured.position += noise_;
  return measured;
}

}  // namespace spelunk::sim
