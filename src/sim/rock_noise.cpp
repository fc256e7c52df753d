#include "spelunk/sim/rock_noise.h"

#include <cmath>

namespace spelunk::sim {
namespace {

double hashToUnit(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
  std::uint64_t h = seed + 0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(x);
  h = (h ^ (h >> 31)) + 0xC2B2AE3D27D4EB4FULL * static_cast<std::uint64_t>(y);
  h = (h ^ (h >> 29)) + 0x165667B19E3779F9ULL * static_cast<std::uint64_t>(z);
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ULL;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>((h ^ (h >> 31)) >> 11) * 0x1.0p-53;
}

double fade(double t) { return t * t * (3.0 - 2.0 * t); }
double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double rockNoise(const Eigen::Vector3d& point, double wavelength_m, std::uint64_t seed) {
  const Eigen::Vector3d scaled = point / wavelength_m;
  const Eigen::Vector3d base(std::floor(scaled.x()), std::floor(scaled.y()),
                             std::floor(scaled.z()));
  const Eigen::Vector3d t = scaled - base;
  const double fx = fade(t.x());
  const double fy = fade(t.y());
  const auto x = static_cast<std::int64_t>(base.x());
  const auto y = static_cast<std::int64_t>(base.y());
  const auto z = static_cast<std::int64_t>(base.z());
  const auto layer = [&](std::int64_t at_z) {
    const double near = mix(hashToUnit(x, y, at_z, seed), hashToUnit(x + 1, y, at_z, seed), fx);
    const double far =
        mix(hashToUnit(x, y + 1, at_z, seed), hashToUnit(x + 1, y + 1, at_z, seed), fx);
    return mix(near, far, fy);
  };
  return mix(layer(z), layer(z + 1), fade(t.z()));
}

double rockNoise(double arc_m, double wavelength_m, std::uint64_t seed) {
  const double scaled = arc_m / wavelength_m;
  const double base = std::floor(scaled);
  const auto x = static_cast<std::int64_t>(base);
  return mix(hashToUnit(x, 0, 0, seed), hashToUnit(x + 1, 0, 0, seed), fade(scaled - base));
}

}  // namespace spelunk::sim
