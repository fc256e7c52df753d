#include "spelunk/ros/input_watch.h"

#include "spelunk/common/message_text.h"

namespace spelunk::bridge {
namespace {

std::string seconds(double value) { return withNumber("%.0f s", value); }

}  // namespace

InputWatch::Wanted InputWatch::expect(const Input& input, double now_s) {
  expected_.push_back({input, now_s, false, std::nullopt, ""});
  return static_cast<Wanted>(expected_.size() - 1);
}

void InputWatch::heard(Wanted input, double now_s) {
  Expected& expected = expected_[static_cast<std::size_t>(input)];
  expected.since_s = now_s;
  expected.was_heard = true;
}

void InputWatch::used(Wanted input, double now_s) {
  Expected& expected = expected_[static_cast<std::size_t>(input)];
  expected.used_s = now_s;
  expected.newest_problem.clear();
}

void InputWatch::report(const std::string& key, const std::string& text, double now_s) {
  newest_ = text;
  newest_s_ = now_s;
  if (throttle_.allows(key, now_s)) log(LogLevel::kWarn, text);
}

void InputWatch::report(Wanted input, const std::string& key, const std::string& text,
                        double now_s) {
  expected_[static_cast<std::size_t>(input)].newest_problem = text;
  report(key, text, now_s);
}

void InputWatch::checkSilence(double now_s) {
  for (const Expected& expected : expected_) {
    const Input& input = expected.input;
    if (now_s - expected.since_s > input.silence_s)
      report("silent " + input.topic, silenceOf(expected, now_s), now_s);
    const std::uint32_t publishers = input.publishers ? input.publishers() : 0;
    if (input.publishers_max > 0 && publishers > input.publishers_max)
      report("publishers " + input.topic,
             std::to_string(publishers) + " publishers of " + input.what + " on '" + input.topic +
                 "', wanted is " + std::to_string(input.publishers_max) +
                 ": stop the others (`rostopic info " + input.topic +
                 "` names them), put each robot into a namespace of its own, or remap '" +
                 input.remapped + "' in the launch file",
             now_s);
  }
}

std::string InputWatch::current(double now_s) const {
  if (!newest_s_ || now_s - *newest_s_ > kShown_s) return "";
  return newest_;
}

std::string InputWatch::silenceOf(const Expected& expected, double now_s) {
  const Input& input = expected.input;
  std::string text = "waits for " + input.what + " on '" + input.topic + "': none " +
                     (expected.was_heard ? "any more " : "") + "since " +
                     seconds(now_s - expected.since_s);
  const std::string remap = "remap '" + input.remapped + "' in the launch file";
  if (!input.publishers) return text + ": start its publisher, or " + remap;
  const std::uint32_t publishers = input.publishers();
  text += " (publishers: " + std::to_string(publishers) + "): ";
  return text +
         (publishers == 0 ? "start the publisher, see that it sends the right type, or "
                          : "see why the publisher sends nothing, or ") +
         remap;
}

std::string InputWatch::waiting(double now_s) const {
  std::string texts;
  for (const Expected& expected : expected_) {
    const Input& input = expected.input;
    if (expected.used_s && now_s - *expected.used_s <= input.silence_s) continue;
    const bool is_silent = !expected.was_heard || now_s - expected.since_s > input.silence_s;
    std::string text = silenceOf(expected, now_s);
    if (!is_silent)
      text = "waits for usable " + input.what + " on '" + input.topic + "'" +
             (expected.newest_problem.empty() ? "" : ": " + expected.newest_problem);
    texts += (texts.empty() ? "" : "; ") + text;
  }
  return texts;
}

}  // namespace spelunk::bridge
