#include "spelunk/common/moved.h"

#include <cstdio>
#include <cstdlib>
#include <regex>

namespace spelunk {
namespace {

/// `value` with as many decimals as `text` has.
std::string likeNumber(const std::string& text, double value) {
  const std::size_t point = text.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(text.size() - point - 1);
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

double numberIn(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

}  // namespace

Eigen::Vector3d Shift::turned(const Eigen::Vector3d& direction) const {
  if (yaw_rad == 0.0) return direction;
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * direction;
}

Shift Shift::inverse() const {
  Shift back(Eigen::Vector3d(Eigen::Vector3d::Zero()), -yaw_rad);
  back.by = -back.turned(by);
  back.about = (*this)(about);
  return back;
}

Shift Shift::after(const Shift& first) const {
  Shift both((*this)(first.by), wrapAngle(yaw_rad + first.yaw_rad));
  both.about = first.about;
  return both;
}

Shift shiftBetween(const Pose& from, const Pose& to) {
  Shift shift(Eigen::Vector3d(Eigen::Vector3d::Zero()), wrapAngle(to.yaw - from.yaw));
  shift.by = to.position - shift.turned(from.position);
  shift.about = from.position;
  return shift;
}

Eigen::Vector3d moved(Eigen::Vector3d point, const Shift& shift) { return shift(point); }

Eigen::Isometry3d moved(Eigen::Isometry3d T, const Shift& shift) {
  T.translation() = shift(T.translation());
  if (shift.yaw_rad != 0.0)
    T.linear() = Eigen::AngleAxisd(shift.yaw_rad, Eigen::Vector3d::UnitZ()) * T.linear();
  return T;
}

Pose moved(Pose pose, const Shift& shift) {
  pose.position = shift(pose.position);
  if (shift.yaw_rad != 0.0) pose.yaw = wrapAngle(pose.yaw + shift.yaw_rad);
  return pose;
}

RobotState moved(RobotState state, const Shift& shift) {
  state.pose = moved(state.pose, shift);
  if (shift.yaw_rad == 0.0) return state;
  state.orientation =
      Eigen::AngleAxisd(shift.yaw_rad, Eigen::Vector3d::UnitZ()) * state.orientation;
  state.velocity = shift.turned(state.velocity);
  return state;
}

TrajectoryPoint moved(TrajectoryPoint point, const Shift& shift) {
  point.pose = moved(point.pose, shift);
  point.velocity = shift.turned(point.velocity);
  return point;
}

AxisAlignedBox moved(AxisAlignedBox box, const Shift& shift) {
  const Eigen::Vector3d by =
      shift.yaw_rad == 0.0 ? shift.by : Eigen::Vector3d(shift(shift.about) - shift.about);
  box.min += by;
  box.max += by;
  return box;
}

NoGoZone moved(NoGoZone zone, const Shift& shift) {
  for (Eigen::Vector2d& corner : zone.polygon)
    corner = shift({corner.x(), corner.y(), 0.0}).head<2>();
  zone.z_min += shift.by.z();
  zone.z_max += shift.by.z();
  return zone;
}

std::string moved(const std::string& sentence, const Shift& shift) {
  static const std::regex place(
      R"(\((-?[0-9]+(?:\.[0-9]+)?), (-?[0-9]+(?:\.[0-9]+)?), (-?[0-9]+(?:\.[0-9]+)?)\))");
  std::string result;
  auto from = sentence.begin();
  for (std::sregex_iterator it(sentence.begin(), sentence.end(), place), end; it != end; ++it) {
    const std::smatch& found = *it;
    const Eigen::Vector3d there =
        shift({numberIn(found[1]), numberIn(found[2]), numberIn(found[3])});
    result.append(from, found[0].first);
    result += "(" + likeNumber(found[1], there.x()) + ", " + likeNumber(found[2], there.y()) +
              ", " + likeNumber(found[3], there.z()) + ")";
    from = found[0].second;
  }
  return result.append(from, sentence.end());
}

}  // namespace spelunk
