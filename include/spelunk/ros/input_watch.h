#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/log.h"

namespace spelunk::bridge {

/// Says what is wrong with the inputs of a node: each problem as a warning at most once in 5 s,
/// the newest one for the status message, and inputs that fell silent. Mission time. Not
/// thread-safe.
class InputWatch {
 public:
  /// An input that must not be silent for longer than `silence_s`; `topic` is the resolved name,
  /// `remapped` the name a launch file remaps.
  struct Input {
    std::string topic;
    std::string remapped;
    double silence_s = 3.0;
  };
  enum class Wanted : std::size_t {};

  Wanted expect(const Input& input, double now_s);

  void heard(Wanted input, double now_s);

  /// A problem called `key`, to be warned of and shown.
  void report(const std::string& key, const std::string& text, double now_s);

  /// Reports every silent input.
  void checkSilence(double now_s);

  /// The newest problem, for kShown_s after it was last reported; else empty.
  [[nodiscard]] std::string current(double now_s) const;

  static constexpr double kShown_s = 5.0;

 private:
  struct Expected {
    Input input;
    double since_s = 0.0;
    bool was_heard = false;
  };
  std::vector<Expected> expected_;
  Throttle throttle_{5.0};
  std::string newest_;
  std::optional<double> newest_s_;
};

}  // namespace spelunk::bridge
