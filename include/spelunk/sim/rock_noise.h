#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace spelunk::sim {

/// Smooth value noise in [0, 1] with features of about `wavelength_m`, from integer hashes and
/// basic arithmetic only: the same bits on every machine.
double rockNoise(const Eigen::Vector3d& point, double wavelength_m, std::uint64_t seed);

/// The same along a line.
double rockNoise(double arc_m, double wavelength_m, std::uint64_t seed);

}  // namespace spelunk::sim
