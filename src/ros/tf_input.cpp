#include "spelunk/ros/tf_input.h"

#include <tf2/exceptions.h>

#include <utility>

namespace spelunk::bridge {
namespace {

constexpr std::uint32_t kTfQueue = 100;

std::string twoFramesText(const std::string& frame, const std::string& first,
                          const std::string& second) {
  return "two nodes send the frame '" + frame + "' on /tf, " + first + " and " + second +
         ": it jumps to and fro and maps mix; give each robot a frame_prefix (simulator, planner "
         "and launch files have it; tf_prefix elsewhere)";
}

}  // namespace

std::string twoClocksText(const std::string& first, const std::string& second) {
  return "two nodes send /clock, " + first + " and " + second +
         ": time jumps to and fro; let one of them send it, e.g. start the other simulator with "
         "clock:=false";
}

TfInput::TfInput(tf2_ros::Buffer& buffer, Report report)
    : buffer_(buffer), report_(std::move(report)), spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  tf_ = node_.subscribe<tf2_msgs::TFMessage>(
      "/tf", kTfQueue, ::boost::function<void(const TfEvent&)>([this](const TfEvent& event) {
        take(event, Lasting::kMoment);
      }));
  tf_static_ = node_.subscribe<tf2_msgs::TFMessage>(
      "/tf_static", kTfQueue, ::boost::function<void(const TfEvent&)>([this](const TfEvent& event) {
        take(event, Lasting::kForEver);
      }));
  clock_ = node_.subscribe("/clock", kTfQueue, &TfInput::onClock, this);
  spinner_.start();
}

TfInput::~TfInput() { spinner_.stop(); }

void TfInput::take(const TfEvent& event, Lasting lasting) {
  const std::string sender = event.getPublisherName();
  for (const geometry_msgs::TransformStamped& transform : event.getConstMessage()->transforms) {
    if (lasting == Lasting::kMoment) {
      sayIfFromTwo(transform.child_frame_id, sender);
      if (isOutOfTurn(transform)) continue;
    }
    try {
      buffer_.setTransform(transform, sender, lasting == Lasting::kForEver);
    } catch (const tf2::TransformException&) {
      // The buffer itself says what is wrong with it.
    }
  }
}

void TfInput::sayIfFromTwo(const std::string& frame, const std::string& sender) {
  const auto both = senders_.heard("frame " + frame, sender);
  if (!both) return;
  newest_[frame] = ::ros::Time();
  report_(SentByTwo::kFrame, twoFramesText(frame, both->first, both->second));
}

/// Stamps of two senders repeat and go back, and tf would say so for each message.
bool TfInput::isOutOfTurn(const geometry_msgs::TransformStamped& transform) {
  const auto newest = newest_.find(transform.child_frame_id);
  if (newest == newest_.end()) return false;
  if (transform.header.stamp <= newest->second) return true;
  newest->second = transform.header.stamp;
  return false;
}

void TfInput::onClock(const ::ros::MessageEvent<rosgraph_msgs::Clock const>& event) {
  if (const auto both = senders_.heard("/clock", event.getPublisherName()))
    report_(SentByTwo::kClock, twoClocksText(both->first, both->second));
}

}  // namespace spelunk::bridge
