#include "spelunk/ros/ros_log.h"

#include <ros/console.h>

#include "spelunk/common/log.h"

namespace spelunk::bridge {

void logToRos(const LocalFrame& frame) {
  setLogSink([frame](LogLevel level, const std::string& line) {
    const std::string text = frame.toCaller(line);
    switch (level) {
      case LogLevel::kInfo:
        ROS_INFO_STREAM(text);
        break;
      case LogLevel::kWarn:
        ROS_WARN_STREAM(text);
        break;
      case LogLevel::kError:
        ROS_ERROR_STREAM(text);
        break;
    }
  });
}

}  // namespace spelunk::bridge
