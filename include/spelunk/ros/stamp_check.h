#pragma once

#include <ros/time.h>

#include <string>

#include "spelunk/ros/cloud_filter.h"

namespace spelunk::bridge {

/// What is wrong with the stamp of a message that is looked at when it is `now`, to be read after
/// "a cloud ..." or "odometry ...": which clock it seems to come from, and the remedy. Empty if it
/// is neither too old nor too new for `limits`.
[[nodiscard]] std::string stampProblem(const ::ros::Time& stamp, const ::ros::Time& now,
                                       const CloudParams& limits);

}  // namespace spelunk::bridge
