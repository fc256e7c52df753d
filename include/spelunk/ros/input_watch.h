#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/log.h"

namespace spelunk::bridge {

/// Says what is wrong with the inputs of a node: each problem as a warning at most once in 5 s,
/// the newest one for the status message, inputs that fell silent, and what the node waits for.
/// Mission time. Not thread-safe.
class InputWatch {
 public:
  /// An input that must not be silent for longer than `silence_s`; `topic` is the resolved name,
  /// `remapped` the name a launch file remaps.
  struct Input {
    std::string what;  ///< "point clouds"
    std::string topic;
    std::string remapped;
    double silence_s = 3.0;
    std::function<std::uint32_t()> publishers;  ///< How many are connected; empty: not known.
    std::uint32_t publishers_max = 0;           ///< More contradict each other; 0: no limit.
  };
  enum class Wanted : std::size_t {};

  Wanted expect(const Input& input, double now_s);

  void heard(Wanted input, double now_s);
  void used(Wanted input, double now_s);  ///< A message of it was good for something.

  /// A problem called `key`, to be warned of and shown.
  void report(const std::string& key, const std::string& text, double now_s);
  /// The same, of a message of an input that could not be used for it.
  void report(Wanted input, const std::string& key, const std::string& text, double now_s);

  /// Reports every silent input, and those with too many publishers.
  void checkSilence(double now_s);

  /// The newest problem, for kShown_s after it was last reported; else empty.
  [[nodiscard]] std::string current(double now_s) const;

  /// For which inputs the node waits, since when and why; empty if each was of use of late.
  [[nodiscard]] std::string waiting(double now_s) const;

  static constexpr double kShown_s = 5.0;

 private:
  struct Expected {
    Input input;
    double since_s = 0.0;  ///< Heard then, or expected from then on.
    bool was_heard = false;
    std::optional<double> used_s;
    std::string newest_problem;  ///< Since it was last used.
  };
  [[nodiscard]] static std::string silenceOf(const Expected& expected, double now_s);

  std::vector<Expected> expected_;
  Throttle throttle_{5.0};
  std::string newest_;
  std::optional<double> newest_s_;
};

}  // namespace spelunk::bridge
