#include <cmath>

#include "mission_impl.h"
#include "spelunk/common/message_text.h"
#include "spelunk/common/stopwatch.h"

namespace spelunk::mission {

using spelunk::toText;  // of numbers; this namespace has its own of states

void Mission::Impl::takeOdometry(const RobotState& base) {
  if (const auto fault = watch.takeOdometry(base, now))
    return say(LogLevel::kWarn, "odometry", *fault);
  if (const auto fall = watch.fall()) happens(Event::kFell, *fall);
  if (way_home.isKnown() && way_home.noteOdometry())
    space.map().markFree(boxAround(watch.pose().position, robot.box_m));
}

map::MapUpdate Mission::Impl::takeScan(const Scan& scan) {
  if (const auto fault = watch.faultOf(scan, now)) {
    say(LogLevel::kWarn, "scan", *fault);
    return {};
  }
  if (!watch.takesScan(scan, now)) return {};
  const Stopwatch stopwatch;
  const Eigen::Vector3d centre = watch.position().value_or(scan.T_world_sensor.translation());
  map::MapUpdate update = space.map().insert(scan, boxAround(centre, space.bodyBox()));
  ground.noteScan(scan);
  last_map_update_ms = stopwatch.milliseconds();
  watch.noteMapped(scan);
  if (update.newly_occupied.empty()) return update;
  way_home.noteOccupied(update.newly_occupied, now);
  flight.noteOccupied(update.newly_occupied, now);
  point.noteOccupied(update.newly_occupied);
  return update;
}

void Mission::Impl::takeRemaining(double remaining_s) {
  if (!endurance.report(remaining_s))
    say(LogLevel::kWarn, "battery", "the reported endurance is not a number: it is not used");
}

/// Why there is no way for the robot, and what may be behind it.
std::string Mission::Impl::withDoubt(const std::string& why) const {
  return notes.doubt.empty() ? why : why + "; " + notes.doubt;
}

std::string Mission::Impl::startProblem() {
  if (!notes.problem.empty()) return notes.problem;
  if (!watch.knowsPose()) return "no odometry yet: check the topic and the state estimation";
  if (watch.isTilted()) return "the robot lies on its side: help it up";
  const Eigen::Vector3d& position = watch.pose().position;
  if (const std::string problem = space.zones().problemAt(position); !problem.empty())
    return problem;
  const Contact contact = space.contactAt(position);
  if (contact.voxels == 0 || flight.posture() == Posture::kLie) return "";
  return withDoubt("start in collision: " + std::to_string(contact.voxels) +
                   " occupied voxels of the map touch the robot's body, " +
                   spelunk::toText(space.bodyBox()) + " m around " + placeOf(position) +
                   ", the nearest at " + placeOf(contact.nearest) +
                   ": move the robot away from it, or correct robot.box_m or the odometry");
}

/// What the robot stands in, and some room around it, is free where it is unknown.
void Mission::Impl::markStandFree() {
  const Eigen::Vector3d& position = watch.pose().position;
  const Eigen::Vector3d room = params.start_clearance_m * Eigen::Vector3d(1.0, 1.0, 0.5);
  AxisAlignedBox stand = boxAround(position, robot.box_m + 2.0 * room);
  if (kindOf(robot) == RobotKind::kLegged)
    stand.min.z() = position.z() - 0.5 * robot.box_m.z();  // below it there is ground
  space.map().markFree(stand);
}

void Mission::Impl::takeOff() {
  if (!way_home.isKnown()) {
    way_home.begin();
    markStandFree();
    ground.assumeGroundHere();
  }
  endurance.begin(now, way_home.isAtHome() ? Endurance::Place::kHome : Endurance::Place::kAway);
}

Answer Mission::Impl::start() {
  if (flight.posture() == Posture::kLie && !way_home.isKnown()) {
    standUp();  // home is where it stands
    return {false, "the robot lies: it stands up now, start again in some seconds"};
  }
  const std::string problem = startProblem();
  if (!problem.empty()) {
    reason = problem;
    return {false, problem};
  }
  takeOff();
  happens(Event::kStartAsked, "started");
  if (isAtRest() && vertical.isNeeded())
    happens(Event::kOnGround, "taking off: climbing to where there is room");
  return {true, "exploring"};
}

Answer Mission::Impl::pause() {
  if (ruleFor(task, Event::kPauseAsked).action == Action::kIgnore)
    return {false, "nothing to pause: the mission is not running"};
  happens(Event::kPauseAsked, "paused: start takes up the mission again");
  return {true, "holding until start"};
}

Answer Mission::Impl::goHomeAsAsked() {
  if (!way_home.isKnown()) return {false, "there is no home yet: start the mission first"};
  if (ruleFor(task, Event::kHomeAsked).action == Action::kIgnore)
    return {false, "emergency stop is on: start releases it"};
  happens(Event::kHomeAsked, "home as asked");
  return {true, "going home"};
}

Answer Mission::Impl::emergencyStop() {
  happens(Event::kStopAsked, "emergency stop: start releases it");
  return {true, "stopped"};
}

Answer Mission::Impl::setBounds(const AxisAlignedBox& box) {
  Answer answer = space.zones().setBounds(box, watch.position());
  if (answer.accepted && flight.active() && !flight.goesHome()) desk.askAt(now);
  return answer;
}

std::string Mission::Impl::goToProblem(const Eigen::Vector3d& target) {
  if (!target.allFinite()) return "the point holds a number that is not finite";
  if (task == Task::kStopped) return "emergency stop is on: start releases it";
  if (mission::isRunning(task)) return "the mission is running: pause it first";
  const std::string problem = startProblem();
  if (!problem.empty()) return problem;
  if (!isAtRest()) return "the robot still moves: wait until it holds";
  const Eigen::Vector3d& here = watch.pose().position;
  const Eigen::Vector3d home = way_home.isKnown() ? way_home.home().position : here;
  const double there_s = (target - here).norm() / robot.speed_max_mps;
  const double home_s = (target - home).norm() / robot.speed_max_mps;
  if (const double margin_s = endurance.guard().marginAfter(there_s, home_s); margin_s < 0.0)
    return "the point is too far: the straight way there and home is " +
           toText(std::round((target - here).norm() + (target - home).norm())) + " m, and " +
           toText(std::ceil(-margin_s)) + " s of endurance are missing for it (" +
           toText(std::round(endurance.guard().remaining())) +
           " s are left, the reserve included): choose a nearer point, or raise the time limit "
           "or robot.endurance_s if the battery allows it";
  return "";
}

Answer Mission::Impl::goTo(const Eigen::Vector3d& target,
                           const navigation::NavigationParams& navigation, double time_limit_s) {
  const std::string problem = goToProblem(target);
  if (!problem.empty()) return {false, problem};
  takeOff();
  static_cast<void>(way_home.refresh(now));
  PointJob job;
  job.params = navigation;
  job.query.goal = {target + Eigen::Vector3d(0.0, 0.0, robot.box_lift_m), watch.pose().yaw};
  job.query.box = robot.box_m;
  job.query.trees = navigation::TreeDetail::kKeep;  // people look at them
  job.query.time_limit_s = time_limit_s;
  happens(Event::kPointAsked, "planning the way to the point that was asked for");
  point.begin(job, now);
  askForPoint();
  return {true, "planning the way to the point that was asked for"};
}

MissionRecord Mission::Impl::record(const planners::PlannerGraph& graph) const {
  MissionRecord record;
  record.bounds = space.zones().bounds();
  record.given_zones = space.zones().given();
  record.marked_zones = space.zones().marked();
  if (way_home.isKnown()) record.trail = way_home.trail();
  record.remaining_s = endurance.guard().remaining();
  record.graph = graph;
  return record;
}

void Mission::Impl::takeUp(const MissionRecord& record) {
  space.zones().restore(record.bounds, record.given_zones, record.marked_zones);
  if (record.trail.empty()) return;
  endurance.takeUp(record.remaining_s);
  desk.forgetReports();
  way_home.takeUp(record.trail, record.marked_zones);
}

}  // namespace spelunk::mission
