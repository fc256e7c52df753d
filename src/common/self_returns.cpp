#include "spelunk/common/self_returns.h"

#include <utility>

namespace spelunk {

std::vector<Eigen::Vector3f> SelfReturns::without(const std::string& sensor,
                                                  std::vector<Eigen::Vector3f> points,
                                                  const Eigen::Isometry3d& T_base_sensor,
                                                  const Eigen::Isometry3d& T_world_base) {
  std::vector<Eigen::Vector3f> others = filter_.without(std::move(points), T_base_sensor);
  watches_.try_emplace(sensor, robot_, range_min_m_)
      .first->second.look(others, T_base_sensor, T_world_base);
  return others;
}

std::string SelfReturns::firstOf(const std::string& (SelfReturnWatch::*text)() const) const {
  for (const auto& [sensor, watch] : watches_)
    if (const std::string& found = (watch.*text)(); !found.empty())
      return "sensor '" + sensor + "': " + found;
  return "";
}

}  // namespace spelunk
