#include "command_line.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/sim/start_proposal.h"

namespace spelunk::evaluation {

std::optional<std::vector<double>> numbersIn(const std::string& text, std::size_t count) {
  std::stringstream stream(text);
  std::vector<double> values;
  for (std::string item; std::getline(stream, item, ',');) {
    char* end = nullptr;
    values.push_back(std::strtod(item.c_str(), &end));
    if (item.empty() || *end != '\0' || !std::isfinite(values.back())) return std::nullopt;
  }
  return values.size() == count ? std::optional(values) : std::nullopt;
}

std::string whyNotFinite(const std::string& text) {
  return numbersIn(text, 1) ? "" : "'" + text + "' is no finite number";
}

std::optional<Pose> startIn(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto values = numbersIn(text, 4);
  if (!values)
    throw OutsideError("--start '" + text + "': write it as x,y,z,yaw in metres and radians");
  return Pose{{values->at(0), values->at(1), values->at(2)}, values->at(3)};
}

Pose startOf(const std::string& text, const sim::WorldMesh& mesh, const Eigen::Vector3d& robot_m) {
  return sim::chooseStart(mesh, startIn(text), robot_m, "--start ");
}

sim::Surroundings surroundingsOf(const std::string& start, const RobotModel& robot,
                                 const map::MapParams& map, double time_limit_s) {
  sim::Surroundings around;
  if (const auto told = startIn(start)) around.start = told->position;
  around.reach_m = reachOf(robot, time_limit_s);
  around.range_m = map::keyRange(map);
  return around;
}

}  // namespace spelunk::evaluation
