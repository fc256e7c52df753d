#pragma once

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/buffer.h>

#include <functional>
#include <map>
#include <string>

#include "spelunk/ros/sender_watch.h"

namespace spelunk::bridge {

/// Fills a tf buffer from /tf and /tf_static, as tf2's own listener does, and knows who sent what:
/// it reports two nodes that send the same frame, or /clock. Has its own queue and thread, so that
/// transforms come in while a cloud enters the map.
class TfInput {
 public:
  enum class SentByTwo { kFrame, kClock };
  using Report = std::function<void(SentByTwo what, const std::string& text)>;

  /// `report` is called in this object's thread with a sentence that names both senders and the
  /// remedy; once each. `buffer` must outlive this.
  TfInput(tf2_ros::Buffer& buffer, Report report);
  ~TfInput();

 private:
  using TfEvent = ::ros::MessageEvent<tf2_msgs::TFMessage const>;
  enum class Lasting { kMoment, kForEver };

  void take(const TfEvent& event, Lasting lasting);
  void sayIfFromTwo(const std::string& frame, const std::string& sender);
  [[nodiscard]] bool isOutOfTurn(const geometry_msgs::TransformStamped& transform);
  void onClock(const ::ros::MessageEvent<rosgraph_msgs::Clock const>& event);

  tf2_ros::Buffer& buffer_;
  Report report_;
  SenderWatch senders_;
  std::map<std::string, ::ros::Time> newest_;  ///< Of frames that two nodes send: newest stamp.
  ::ros::NodeHandle node_;
  ::ros::CallbackQueue queue_;
  ::ros::Subscriber tf_;
  ::ros::Subscriber tf_static_;
  ::ros::Subscriber clock_;
  ::ros::AsyncSpinner spinner_;
};

/// What is wrong if two nodes send /clock, and what helps.
[[nodiscard]] std::string twoClocksText(const std::string& first, const std::string& second);

}  // namespace spelunk::bridge
