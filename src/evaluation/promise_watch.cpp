#include "spelunk/evaluation/promise_watch.h"

#include <algorithm>

#include "spelunk/common/message_text.h"

namespace spelunk::evaluation {
namespace {

using mission::MissionState;

constexpr double kTruthStep_m = 0.25;  // a third of a body
constexpr double kTruthStart_m = 0.5;  // nearer, the robot itself is, which is counted elsewhere
constexpr double kBeginGap_m = 3.5;  // what is joined without a check, and half a second of flight
constexpr double kHomeGap_m = 0.1;
constexpr double kRounding_s = 0.1;
constexpr double kSpeedSlack_mps = 0.3;  // of a controller that brakes into a narrow place

bool isUnderWay(MissionState state) {
  return state == MissionState::kTakeOff || state == MissionState::kExplore ||
         state == MissionState::kReposition || state == MissionState::kHome ||
         state == MissionState::kHold;
}

}  // namespace

void PromiseWatch::look(double now_s, const Pose& pose, double true_speed_mps, Paths paths) {
  const mission::MissionStatus status = mission_.status();
  const double step_s = now_s - last_s_;
  last_s_ = now_s;
  if (!isUnderWay(status.state)) return;
  is_broken_ = false;
  if (!status.way_home_problem.empty()) {
    record_.unsure_s += step_s;
    if (record_.unsure_why.empty()) record_.unsure_why = status.way_home_problem;
  } else {
    lookAtWayHome(now_s, status, pose);
    if (paths == Paths::kComparable) lookAtTruth(now_s, mission_.wayHome());
  }
  if (paths == Paths::kComparable) lookAtSpeed(now_s, status, pose, true_speed_mps);
  if (is_broken_) ++record_.broken_ticks;
}

void PromiseWatch::lookAtWayHome(double now_s, const mission::MissionStatus& status,
                                 const Pose& pose) {
  const Path trail = mission_.trail();
  const Path way = mission_.wayHome();
  if (trail.empty()) return;
  if (way.empty()) return note(now_s, "no way home is known, and nothing was said");
  if (distance(way.back(), trail.front()) > kHomeGap_m)
    note(now_s, "the way home does not end at home");
  if (distance(way.front(), pose) > kBeginGap_m)
    note(now_s, "the way home does not begin where the robot is");
  if (status.way_home_s > status.remaining_s + kRounding_s &&
      distance(pose, trail.front()) > kBeginGap_m)
    note(now_s, "the way home does not fit the endurance, and nothing was said");
}

void PromiseWatch::lookAtTruth(double now_s, const Path& way) {
  if (way.size() < 2) return;
  const double length = lengthOf(way);
  for (double arc = std::min(kTruthStart_m, length); arc < length; arc += kTruthStep_m) {
    const Eigen::Vector3d at = poseAt(way, arc).position;
    if (scene_.boxDistance(at, body_m_, kTruthStep_m) > 0.0) continue;
    return note(now_s, "the way home leads through rock at " + placeOf(at));
  }
}

void PromiseWatch::lookAtSpeed(double now_s, const mission::MissionStatus& status, const Pose& pose,
                               double speed_mps) {
  const RobotModel& robot = mission_.robot();
  const bool is_full = (status.clear_box_m.array() >= robot.box_m.array()).all();
  if (status.state != MissionState::kHome || status.clear_box_m.isZero() || is_full) return;
  const Eigen::Vector3d centre = pose.position + Eigen::Vector3d(0.0, 0.0, robot.box_lift_m);
  if (scene_.boxDistance(centre, robot.box_m, kTruthStep_m) > 0.0) return;
  if (speed_mps > narrowSpeed(robot) + kSpeedSlack_mps)
    note(now_s, "a narrow place is flown through fast");
}

void PromiseWatch::note(double now_s, const std::string& what) {
  is_broken_ = true;
  const auto kind = what.substr(0, what.find(" at ("));
  for (const std::string& fault : record_.faults)
    if (fault.find(kind) != std::string::npos) return;
  record_.faults.push_back(withNumber("%.1f s: ", now_s) + what);
}

}  // namespace spelunk::evaluation
