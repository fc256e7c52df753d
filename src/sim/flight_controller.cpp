#include "spelunk/sim/flight_controller.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Natural frequencies (rad/s) and damping of the loops: the attitude loop stays below the rotors'
// lag, the position loop below a third of the attitude loop.
constexpr double kPositionFrequency = 2.8;
constexpr double kPositionDamping = 1.0;
constexpr double kTiltFrequency = 11.0;
constexpr double kTiltDamping = 0.9;
constexpr double kYawFrequency = 4.0;
constexpr double kYawDamping = 1.0;
constexpr double kPositionErrorMax = 1.0;  ///< Metres.
constexpr double kVelocityErrorMax = 2.0;  ///< m/s
constexpr double kTiltMax = 0.6;           ///< rad; beyond it, height is held first.
constexpr double kYawErrorMax = 0.5;
constexpr double kLiftShareMin = 0.35;  ///< Of the weight: rotors that idle cannot steer.

Vector3d limited(const Vector3d& vector, double length_max) {
  const double length = vector.norm();
  return length > length_max ? Vector3d(vector * (length_max / length)) : vector;
}

Vector3d vee(const Matrix3d& skew) { return {skew(2, 1), skew(0, 2), skew(1, 0)}; }

/// The force the rotors shall make, world frame (Lee 2010, eq. 15, without the sign of "z down"),
/// within the tilt and thrust limits.
Vector3d wantedForce(const Airframe& airframe, const BodyState& state,
                     const TrajectoryPoint& reference, const Vector3d& acceleration_ahead) {
  const Vector3d position_error =
      limited(reference.pose.position - state.position, kPositionErrorMax);
  const Vector3d velocity_error = limited(reference.velocity - state.velocity, kVelocityErrorMax);
  const Vector3d acceleration = kPositionFrequency * kPositionFrequency * position_error +
                                2.0 * kPositionDamping * kPositionFrequency * velocity_error +
                                acceleration_ahead + kGravity * Vector3d::UnitZ();
  Vector3d force = airframe.mass_kg * acceleration + airframe.drag_coefficient * reference.velocity;
  const double weight = airframe.mass_kg * kGravity;
  force.z() = std::clamp(force.z(), kLiftShareMin * weight, 0.95 * airframe.thrust_max_n);
  const double spare_squared =
      airframe.thrust_max_n * airframe.thrust_max_n - force.z() * force.z();
  const double sideways_max = std::min(force.z() * std::tan(kTiltMax), std::sqrt(spare_squared));
  const double sideways = force.head<2>().norm();
  if (sideways > sideways_max) force.head<2>() *= sideways_max / sideways;
  return force;
}

/// World from base with z along `up` and x as near to the heading as that allows.
Matrix3d attitudeAlong(const Vector3d& up, double yaw) {
  const Vector3d z = up.normalized();
  const Vector3d heading(std::cos(yaw), std::sin(yaw), 0.0);
  const Vector3d y = z.cross(heading).normalized();
  Matrix3d attitude;
  attitude << y.cross(z), y, z;
  return attitude;
}

}  // namespace

Wrench computeWrench(const Airframe& airframe, const BodyState& state,
                     const TrajectoryPoint& reference, const Vector3d& acceleration_ahead) {
  const Matrix3d attitude = state.orientation.toRotationMatrix();
  const Vector3d force = wantedForce(airframe, state, reference, acceleration_ahead);
  const Matrix3d wanted = attitudeAlong(force, reference.pose.yaw);
  // Eq. (10), (11): errors of attitude and angular velocity; only heading turns in the reference.
  const Matrix3d relative = wanted.transpose() * attitude;
  Vector3d attitude_error = 0.5 * vee(relative - relative.transpose());
  if (relative.trace() < 1.0) attitude_error *= 1.0 / std::max(attitude_error.norm(), 1e-3);
  attitude_error.z() = std::clamp(attitude_error.z(), -kYawErrorMax, kYawErrorMax);
  const Vector3d rate_error =
      state.angular_velocity - attitude.transpose() * (reference.yaw_rate * Vector3d::UnitZ());
  const Vector3d frequency(kTiltFrequency, kTiltFrequency, kYawFrequency);
  const Vector3d damping(kTiltDamping, kTiltDamping, kYawDamping);
  const Vector3d angular_acceleration =
      -(frequency.cwiseProduct(frequency).cwiseProduct(attitude_error) +
        2.0 * damping.cwiseProduct(frequency).cwiseProduct(rate_error));
  Wrench wrench;
  wrench.thrust_n = std::max(0.0, force.dot(attitude.col(2)));
  // Eq. (16), with the gyroscopic term of the turning body.
  wrench.torque_nm =
      airframe.inertia_kgm2.cwiseProduct(angular_acceleration) +
      state.angular_velocity.cross(airframe.inertia_kgm2.cwiseProduct(state.angular_velocity));
  return wrench;
}

Trajectory brakingTrajectory(double time_s, const TrajectoryPoint& from, double deceleration_mps2) {
  require(deceleration_mps2 > 0.0, "brakingTrajectory: deceleration must be positive");
  const double duration_s = std::max(0.05, from.velocity.norm() / deceleration_mps2);
  TrajectoryPoint start = from;
  start.time_s = time_s;
  start.acceleration = -from.velocity / duration_s;
  TrajectoryPoint rest;
  rest.time_s = time_s + duration_s;
  rest.pose.position = from.pose.position + 0.5 * duration_s * from.velocity;
  rest.pose.yaw = wrapAngle(from.pose.yaw + 0.5 * duration_s * from.yaw_rate);
  return {start, rest};  // constant deceleration: a cubic through both is exact
}

}  // namespace spelunk::sim
