#include "spelunk/ros/robot_description.h"

#include <cmath>
#include <sstream>

#include "spelunk/sim/walker_urdf.h"

namespace spelunk::bridge {
namespace {

constexpr double kRotorHeight_m = 0.02;
constexpr double kRotorShare = 0.8;  ///< Of half the distance between neighbouring rotors.

void addVisual(const Eigen::Vector3d& centre, const std::string& shape, const char* rgba,
               std::ostream& text) {
  text << "    <visual>\n      <origin xyz=\"" << centre.x() << " " << centre.y() << " "
       << centre.z() << "\"/>\n      <geometry>" << shape << "</geometry>\n      <material name=\""
       << rgba << "\"><color rgba=\"" << rgba << "\"/></material>\n    </visual>\n";
}

std::string aerialUrdf(const sim::SimParams& params, const std::string& base_link) {
  const Eigen::Vector3d& body = params.body_m;
  std::ostringstream box;
  box << "<box size=\"" << 0.5 * body.x() << " " << 0.3 * body.y() << " " << 0.6 * body.z()
      << "\"/>";
  const double half_turn = M_PI / params.rotors;
  std::ostringstream rotor;
  rotor << "<cylinder radius=\"" << kRotorShare * params.rotor_arm_m * std::sin(half_turn)
        << "\" length=\"" << kRotorHeight_m << "\"/>";
  std::ostringstream text;
  text << "<?xml version=\"1.0\"?>\n<robot name=\"aerial\">\n  <link name=\"" << base_link
       << "\">\n";
  addVisual(Eigen::Vector3d::Zero(), box.str(), "0.70 0.10 0.08 1", text);
  for (int k = 0; k < params.rotors; ++k) {
    const double angle = (2 * k + 1) * half_turn;
    addVisual({params.rotor_arm_m * std::cos(angle), params.rotor_arm_m * std::sin(angle),
               0.5 * body.z() - kRotorHeight_m},
              rotor.str(), "0.18 0.18 0.20 1", text);
  }
  text << "  </link>\n</robot>\n";
  return text.str();
}

}  // namespace

std::string robotDescription(const RobotModel& robot, const sim::SimParams& params,
                             const std::string& base_link) {
  return kindOf(robot) == RobotKind::kLegged ? sim::walkerUrdf(params.walker, base_link)
                                             : aerialUrdf(params, base_link);
}

}  // namespace spelunk::bridge
