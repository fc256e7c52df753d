#pragma once

#include <functional>
#include <map>
#include <string>

namespace spelunk {

enum class LogLevel { kInfo, kWarn, kError };

/// Where the lines go. One sink a process: ros/ installs ROS, mains the terminal, tests a recorder.
using LogSink = std::function<void(LogLevel, const std::string&)>;

/// Replaces the sink; an empty one discards. Thread-safe.
void setLogSink(LogSink sink);

/// Passes one line to the sink. Thread-safe.
void log(LogLevel level, const std::string& text);

/// Lets the same message through at most once in a period of mission time, so that no fault can
/// fill a disk. Not thread-safe: one per owner.
class Throttle {
 public:
  explicit Throttle(double period_s = 5.0) : period_s_(period_s) {}

  /// Whether the message called `key` may be said at `now_s`; if so it counts as said. A clock that
  /// jumped back lets it through.
  bool allows(const std::string& key, double now_s);

 private:
  double period_s_;
  std::map<std::string, double> last_s_;
};

}  // namespace spelunk
