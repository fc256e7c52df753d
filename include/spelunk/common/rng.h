#pragma once

#include <cstdint>
#include <string_view>

namespace spelunk {

/// splitmix64: the same (seed, name) gives the same draws with every compiler and library.
/// One run seed is forked into one named stream a consumer; nobody draws from the run's own.
class Rng {
 public:
  explicit Rng(std::uint64_t seed) : state_(seed) {}

  /// An independent stream, e.g. `run_rng.fork("lidar/noise")`. Does not advance this one.
  [[nodiscard]] Rng fork(std::string_view name) const;

  std::uint64_t next();
  double uniform();                         ///< [0, 1)
  double uniform(double low, double high);  ///< [low, high)
  double normal();                          ///< Mean 0, variance 1 (Marsaglia's polar method).
  int below(int count);                     ///< 0 .. count-1; count > 0.

 private:
  std::uint64_t state_;
};

}  // namespace spelunk
