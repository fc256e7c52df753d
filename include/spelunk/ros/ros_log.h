#pragma once

#include "spelunk/common/local_frame.h"

namespace spelunk::bridge {

/// Sends the lines of common/log.h to ROS's own log. Places that they name are given in `frame`;
/// the log has them in the caller's.
void logToRos(const LocalFrame& frame = {});

}  // namespace spelunk::bridge
