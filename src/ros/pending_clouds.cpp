#include "spelunk/ros/pending_clouds.h"

#include "spelunk/common/message_text.h"
#include "spelunk/ros/frame_names.h"
#include "spelunk/ros/stamp_check.h"

namespace spelunk::bridge {
namespace {

std::string seconds(double value) { return withNumber("%.2f s", value); }

}  // namespace

std::string PendingClouds::push(const sensor_msgs::PointCloud2::ConstPtr& cloud,
                                const ::ros::Time& now) {
  const std::string frame = frameName(cloud->header.frame_id);
  if (frame.empty())
    return "a cloud has no frame_id: set the frame of the sensor in its driver, and publish it on "
           "tf";
  const std::string stamp_problem = stampProblem(cloud->header.stamp, now, params_);
  if (!stamp_problem.empty()) return "a cloud in frame '" + frame + "' " + stamp_problem;
  waiting_.push_back({cloud, now});
  if (waiting_.size() > kCapacity) waiting_.pop_front();
  return "";
}

std::vector<PendingClouds::Item> PendingClouds::take(const PlaceLookup& lookup,
                                                     const ::ros::Time& now) {
  std::vector<Item> taken;
  std::deque<Waiting> still_waiting;
  for (const Waiting& waiting : waiting_) {
    const std::string frame = frameName(waiting.cloud->header.frame_id);
    const auto place = lookup(frame, waiting.cloud->header.stamp);
    if (place.value) {
      taken.push_back({waiting.cloud, *place.value, ""});
    } else if ((now - waiting.since).toSec() >= params_.tf_wait_s) {
      taken.push_back({waiting.cloud,
                       {},
                       "where a cloud in frame '" + frame + "' was taken from is not known after " +
                           seconds(params_.tf_wait_s) + ": " + place.problem});
    } else {
      still_waiting.push_back(waiting);
    }
  }
  waiting_ = std::move(still_waiting);
  return taken;
}

}  // namespace spelunk::bridge
