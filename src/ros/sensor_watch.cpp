#include "spelunk/ros/sensor_watch.h"

#include <algorithm>

namespace spelunk::bridge {
namespace {

const char* costOf(SensorKind kind) {
  return kind == SensorKind::kDepthCamera
             ? "the ground near the robot is seen late or not at all, so it stops and turns back "
               "more often"
             : "what only this sensor sees stays unknown";
}

}  // namespace

SensorWatch::SensorWatch(const RobotModel& robot, double silence_s) : silence_s_(silence_s) {
  for (const SensorModel& sensor : robot.sensor_models)
    sensors_.push_back({sensor.name, kindOf(sensor)});
}

void SensorWatch::heard(const std::string& frame, double now_s) {
  for (Watched& sensor : sensors_) {
    if (sensor.name != frame) continue;
    sensor.heard_s = now_s;
    if (has_begun_) return;
    has_begun_ = true;
    for (Watched& other : sensors_) other.heard_s = now_s;
  }
}

std::vector<std::string> SensorWatch::news(double now_s) {
  std::vector<std::string> texts;
  if (!has_begun_) return texts;
  const auto is_silent = [&](const Watched& sensor) { return now_s - sensor.heard_s > silence_s_; };
  // All silent: that is a matter of the topic, which is watched elsewhere.
  if (std::all_of(sensors_.begin(), sensors_.end(), is_silent)) return texts;
  for (Watched& sensor : sensors_) {
    if (sensor.is_missing == is_silent(sensor)) continue;
    sensor.is_missing = !sensor.is_missing;
    texts.push_back(sensor.is_missing
                        ? "no clouds in frame '" + sensor.name +
                              "': going on with the other sensors; " + costOf(sensor.kind) +
                              ". Check its driver, or take it out of robot.sensors"
                        : "clouds in frame '" + sensor.name + "' are back");
  }
  return texts;
}

}  // namespace spelunk::bridge
