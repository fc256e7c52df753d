#include "spelunk/ros/node_main.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/topic_manager.h>
#include <rosgraph_msgs/Log.h>

#include <cstdlib>
#include <exception>

#include "spelunk/common/contract.h"
#include "spelunk/ros/ros_log.h"

namespace spelunk::bridge {
namespace {

constexpr double kLogPatience_s = 2.0;
constexpr double kLookPeriod_s = 0.05;

/// Hears what ROS's log has taken. A node that ends at once takes its last line along, for the log
/// connects to a new node only after a while.
class LogEcho {
 public:
  LogEcho() {
    node_.setCallbackQueue(&queue_);
    heard_ = node_.subscribe("/rosout_agg", 100, &LogEcho::take, this);
    waitFor([&] {
      return heard_.getNumPublishers() > 0 &&
             ::ros::TopicManager::instance()->getNumSubscribers("/rosout") > 0;
    });
  }

  /// Returns when the log has the text, or after kLogPatience_s.
  void waitFor(const std::string& text) {
    waitFor([&] { return last_text_ == text; });
  }

 private:
  void waitFor(const std::function<bool()>& is_so) {
    const ::ros::WallTime give_up = ::ros::WallTime::now() + ::ros::WallDuration(kLogPatience_s);
    while (!is_so() && ::ros::ok() && ::ros::WallTime::now() < give_up)
      queue_.callAvailable(::ros::WallDuration(kLookPeriod_s));
  }

  void take(const rosgraph_msgs::Log& line) {
    if (line.name == ::ros::this_node::getName()) last_text_ = line.msg;
  }

  ::ros::CallbackQueue queue_;
  ::ros::NodeHandle node_;
  ::ros::Subscriber heard_;
  std::string last_text_;
};

void requireMaster() {
  if (::ros::master::check()) return;
  throw OutsideError("no ROS master answers at " + ::ros::master::getURI() +
                     ": start roscore, or start this node by roslaunch; ROS_MASTER_URI names a "
                     "master elsewhere");
}

}  // namespace

int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& body) {
  try {
    ::ros::init(argc, argv, name);
    requireMaster();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(name << ": " << error.what());
    return EXIT_FAILURE;
  }
  const ::ros::NodeHandle keeps_ros_running;  // ROS ends with its last handle, and its log with it.
  logToRos();
  try {
    body();
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    LogEcho log;
    const std::string text = error.what();
    ROS_FATAL_STREAM(text);
    log.waitFor(text);
    return EXIT_FAILURE;
  }
}

}  // namespace spelunk::bridge
