#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/mission/answer.h"

namespace spelunk::mission {

/// Where the robot may be: inside the bounds, outside the no-go zones that people set and outside
/// those that it marked itself. World frame, metres.
class Zones {
 public:
  /// `box`: the robot's, full extents, metres.
  explicit Zones(const Eigen::Vector3d& box) : box_(box) {}

  /// Refused if they are empty or leave the robot outside; `robot_at`: none if it is not known.
  Answer setBounds(const AxisAlignedBox& bounds, const std::optional<Eigen::Vector3d>& robot_at);
  /// Replaces the zones that people set. Refused if one is no zone or holds the robot.
  Answer setGiven(std::vector<NoGoZone> zones, const std::optional<Eigen::Vector3d>& robot_at);
  /// Adds a zone for good that the robot found by itself.
  void mark(NoGoZone zone);
  /// Takes up what was saved.
  void restore(const AxisAlignedBox& bounds, std::vector<NoGoZone> given,
               const std::vector<NoGoZone>& marked);

  [[nodiscard]] const AxisAlignedBox& bounds() const { return bounds_; }
  [[nodiscard]] const std::vector<NoGoZone>& all() const { return all_; }
  [[nodiscard]] const std::vector<NoGoZone>& given() const { return given_; }
  [[nodiscard]] std::vector<NoGoZone> marked() const;
  [[nodiscard]] int markedCount() const;
  /// Another number after each change: what was checked against the zones before is to be checked
  /// again.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

  /// Why the robot may not be at a place; empty if it may.
  [[nodiscard]] std::string problemAt(const Eigen::Vector3d& robot_at) const;

 private:
  void join(const std::vector<NoGoZone>& marked);
  [[nodiscard]] std::string faultOf(const NoGoZone& zone,
                                    const std::optional<Eigen::Vector3d>& robot_at) const;

  Eigen::Vector3d box_;
  AxisAlignedBox bounds_;
  std::vector<NoGoZone> given_;
  std::vector<NoGoZone> all_;  ///< Those that people set, then those that the robot marked.
  std::uint64_t revision_ = 1;
};

}  // namespace spelunk::mission
