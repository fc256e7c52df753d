#include "spelunk/ros/input_watch.h"

#include <cstdio>

namespace spelunk::bridge {

InputWatch::Wanted InputWatch::expect(const Input& input, double now_s) {
  expected_.push_back({input, now_s, false});
  return static_cast<Wanted>(expected_.size() - 1);
}

void InputWatch::heard(Wanted input, double now_s) {
  Expected& expected = expected_[static_cast<std::size_t>(input)];
  expected.since_s = now_s;
  expected.was_heard = true;
}

void InputWatch::report(const std::string& key, const std::string& text, double now_s) {
  newest_ = text;
  newest_s_ = now_s;
  if (throttle_.allows(key, now_s)) log(LogLevel::kWarn, text);
}

void InputWatch::checkSilence(double now_s) {
  for (const Expected& expected : expected_) {
    const double silent_s = now_s - expected.since_s;
    if (silent_s <= expected.input.silence_s) continue;
    char since[32];
    std::snprintf(since, sizeof(since), "%.0f s", silent_s);
    report("silent " + expected.input.topic,
           std::string(expected.was_heard ? "no more message" : "no message") + " on '" +
               expected.input.topic + "' for " + since +
               ": is its publisher running? Else remap '" + expected.input.remapped +
               "' in the launch file",
           now_s);
  }
}

std::string InputWatch::current(double now_s) const {
  if (!newest_s_ || now_s - *newest_s_ > kShown_s) return "";
  return newest_;
}

}  // namespace spelunk::bridge
