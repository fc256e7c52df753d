#pragma once

#include <chrono>

namespace spelunk {

/// Wall time for counters and timings only; no decision of the core depends on it.
class Stopwatch {
 public:
  [[nodiscard]] double milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace spelunk
