#include "spelunk/ros/stamp_check.h"

#include <cmath>

#include "spelunk/common/message_text.h"

namespace spelunk::bridge {
namespace {

/// No queue holds a message so long, no clock of a robot is wrong by so much: it is another clock.
constexpr double kOtherClock_s = 86400.0;
constexpr double kGpsAheadOfUtc_s = 18.0;
constexpr double kTaiAheadOfUtc_s = 37.0;
constexpr double kNear_s = 0.9;

std::string seconds(double value) { return withNumber("%.2f s", value); }

std::string ofThePast(double stamp_s, double age_s, double age_max_s) {
  if (age_s > kOtherClock_s)
    return "is stamped " + seconds(stamp_s) + ", which is " + seconds(age_s) +
           " before ROS time: its sender uses the sensor's own clock or simulated time. Have its "
           "driver stamp with ROS time, or set /use_sim_time before planner_node starts if a "
           "simulator or a bag sends /clock";
  return "is " + seconds(age_s) + " old, allowed are " + seconds(age_max_s) +
         ": synchronise the clocks of the computers, check use_sim_time, or raise cloud/age_max_s";
}

std::string ofTheFuture(double stamp_s, double ahead_s, double ahead_max_s) {
  if (ahead_s > kOtherClock_s)
    return "is stamped " + seconds(stamp_s) + ", " + seconds(ahead_s) +
           " in the future: its sender uses another clock than this node. Set /use_sim_time for "
           "both of them or for neither, and start them anew";
  std::string text = "is stamped " + seconds(ahead_s) + " in the future, allowed are " +
                     seconds(ahead_max_s) + ": ";
  if (std::abs(ahead_s - kGpsAheadOfUtc_s) < kNear_s)
    text += "GPS time is 18 s ahead of UTC; have the driver stamp in UTC. Else ";
  if (std::abs(ahead_s - kTaiAheadOfUtc_s) < kNear_s)
    text += "TAI (PTP) is 37 s ahead of UTC; set the sensor's UTC offset. Else ";
  return text +
         "synchronise the clocks of the computers, check use_sim_time, or raise cloud/future_max_s";
}

}  // namespace

std::string stampProblem(const ::ros::Time& stamp, const ::ros::Time& now,
                         const CloudParams& limits) {
  const double age_s = now.toSec() - stamp.toSec();
  if (age_s >= -limits.future_max_s && age_s <= limits.age_max_s) return "";
  if (stamp.isZero())
    return "has stamp 0: its driver must fill header.stamp with the ROS time of the measurement";
  return age_s > 0.0 ? ofThePast(stamp.toSec(), age_s, limits.age_max_s)
                     : ofTheFuture(stamp.toSec(), -age_s, limits.future_max_s);
}

}  // namespace spelunk::bridge
