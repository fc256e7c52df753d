#include "spelunk/ros/pending_clouds.h"

#include <cstdio>

namespace spelunk::bridge {
namespace {

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2f s", value);
  return text;
}

}  // namespace

std::string PendingClouds::push(const sensor_msgs::PointCloud2::ConstPtr& cloud,
                                const ::ros::Time& now) {
  if (cloud->header.frame_id.empty())
    return "a cloud has no frame_id: set the frame of the sensor in its driver";
  const double age_s = (now - cloud->header.stamp).toSec();
  if (age_s < -params_.future_max_s)
    return "a cloud in frame '" + cloud->header.frame_id + "' is stamped " + seconds(-age_s) +
           " in the future: synchronise the clocks, and check use_sim_time";
  if (age_s > params_.age_max_s)
    return "a cloud in frame '" + cloud->header.frame_id + "' is " + seconds(age_s) +
           " old: synchronise the clocks, check use_sim_time, or raise cloud/age_max_s";
  waiting_.push_back({cloud, now});
  if (waiting_.size() > kCapacity) waiting_.pop_front();
  return "";
}

std::vector<PendingClouds::Item> PendingClouds::take(const TransformLookup& lookup,
                                                     const ::ros::Time& now) {
  std::vector<Item> taken;
  std::deque<Waiting> still_waiting;
  for (const Waiting& waiting : waiting_) {
    const std_msgs::Header& header = waiting.cloud->header;
    const auto T_world_sensor = lookup(header.frame_id, header.stamp);
    if (T_world_sensor.value) {
      taken.push_back({waiting.cloud, *T_world_sensor.value, ""});
    } else if ((now - waiting.since).toSec() >= params_.tf_wait_s) {
      taken.push_back({waiting.cloud, Eigen::Isometry3d::Identity(),
                       "no transform for a cloud in frame '" + header.frame_id + "' after " +
                           seconds(params_.tf_wait_s) + " (" + T_world_sensor.problem +
                           "): publish it on tf, or raise cloud/tf_wait_s"});
    } else {
      still_waiting.push_back(waiting);
    }
  }
  waiting_ = std::move(still_waiting);
  return taken;
}

}  // namespace spelunk::bridge
