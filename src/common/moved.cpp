#include "spelunk/common/moved.h"

#include <cstdio>
#include <cstdlib>
#include <regex>

namespace spelunk {
namespace {

/// "12.50" moved by 3 is "15.50".
std::string movedNumber(const std::string& text, double by) {
  const std::size_t point = text.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(text.size() - point - 1);
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, std::strtod(text.c_str(), nullptr) + by);
  return buffer;
}

}  // namespace

Eigen::Vector3d moved(Eigen::Vector3d point, const Eigen::Vector3d& by) { return point + by; }

Eigen::Isometry3d moved(Eigen::Isometry3d T, const Eigen::Vector3d& by) {
  T.translation() += by;
  return T;
}

Pose moved(Pose pose, const Eigen::Vector3d& by) {
  pose.position += by;
  return pose;
}

RobotState moved(RobotState state, const Eigen::Vector3d& by) {
  state.pose.position += by;
  return state;
}

TrajectoryPoint moved(TrajectoryPoint point, const Eigen::Vector3d& by) {
  point.pose.position += by;
  return point;
}

AxisAlignedBox moved(AxisAlignedBox box, const Eigen::Vector3d& by) {
  box.min += by;
  box.max += by;
  return box;
}

NoGoZone moved(NoGoZone zone, const Eigen::Vector3d& by) {
  for (Eigen::Vector2d& corner : zone.polygon) corner += by.head<2>();
  zone.z_min += by.z();
  zone.z_max += by.z();
  return zone;
}

std::string moved(const std::string& sentence, const Eigen::Vector3d& by) {
  static const std::regex place(
      R"(\((-?[0-9]+(?:\.[0-9]+)?), (-?[0-9]+(?:\.[0-9]+)?), (-?[0-9]+(?:\.[0-9]+)?)\))");
  std::string result;
  auto from = sentence.begin();
  for (std::sregex_iterator it(sentence.begin(), sentence.end(), place), end; it != end; ++it) {
    result.append(from, (*it)[0].first);
    result += "(" + movedNumber((*it)[1], by.x()) + ", " + movedNumber((*it)[2], by.y()) + ", " +
              movedNumber((*it)[3], by.z()) + ")";
    from = (*it)[0].second;
  }
  return result.append(from, sentence.end());
}

}  // namespace spelunk
