#pragma once

namespace spelunk::bridge {

/// Sends the lines of common/log.h to ROS's own log. Call before threads start.
void logToRos();

}  // namespace spelunk::bridge
