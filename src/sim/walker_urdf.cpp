#include "spelunk/sim/walker_urdf.h"

#include <Eigen/Core>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "spelunk/sim/leg_kinematics.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;
constexpr double kLegRadius_m = 0.025;
constexpr double kHipRadius_m = 0.05;
constexpr double kFootRadius_m = 0.03;

/// Writes elements; numbers in full, so that nothing is lost to the text.
class Writer {
 public:
  Writer() { text_ << std::setprecision(17); }

  void link(const std::string& name, const std::string& shape, const Vector3d& centre,
            const char* material) {
    text_ << "  <link name=\"" << name << "\">\n    <visual>\n      <origin xyz=\""
          << numbers(centre) << "\" rpy=\"0 0 0\"/>\n      <geometry>" << shape
          << "</geometry>\n      <material name=\"" << material
          << "\"/>\n    </visual>\n  </link>\n";
  }

  void fixed(const std::string& name, const std::string& parent, const std::string& child,
             const Vector3d& origin) {
    open(name, "fixed", parent, child, origin);
    text_ << "  </joint>\n";
  }

  void revolute(const std::string& name, const std::string& parent, const std::string& child,
                const Vector3d& origin, const char* axis, double low, double high) {
    open(name, "revolute", parent, child, origin);
    text_ << "    <axis xyz=\"" << axis << "\"/>\n    <limit lower=\"" << low << "\" upper=\""
          << high << "\" effort=\"80\" velocity=\"12\"/>\n  </joint>\n";
  }

  void colour(const char* name, const char* rgba) {
    text_ << "  <material name=\"" << name << "\"><color rgba=\"" << rgba << "\"/></material>\n";
  }

  [[nodiscard]] std::string robot() const {
    return "<?xml version=\"1.0\"?>\n<robot name=\"walker\">\n" + text_.str() + "</robot>\n";
  }

  static std::string numbers(const Vector3d& v) {
    std::ostringstream text;
    text << std::setprecision(17) << v.x() << " " << v.y() << " " << v.z();
    return text.str();
  }

 private:
  void open(const std::string& name, const char* type, const std::string& parent,
            const std::string& child, const Vector3d& origin) {
    text_ << "  <joint name=\"" << name << "\" type=\"" << type << "\">\n    <parent link=\""
          << parent << "\"/>\n    <child link=\"" << child << "\"/>\n    <origin xyz=\""
          << numbers(origin) << "\" rpy=\"0 0 0\"/>\n";
  }

  std::ostringstream text_;
};

std::string cylinder(double length) {
  std::ostringstream text;
  text << "<cylinder radius=\"" << kLegRadius_m << "\" length=\"" << length << "\"/>";
  return text.str();
}

std::string sphere(double radius) {
  std::ostringstream text;
  text << "<sphere radius=\"" << radius << "\"/>";
  return text.str();
}

void addLeg(const WalkerParams& params, std::size_t index, const std::string& base_link,
            Writer& writer) {
  const Leg leg(params, index);
  const std::string name = kLegNames[index];
  const double abduction = params.abduction_max_deg * kDegree;
  const double flexion = params.flexion_max_deg * kDegree;
  // Front knees bend to the negative side.
  const bool is_front = index < 2;
  const double bend_min = params.knee_min_deg * kDegree;
  const double bend_max = params.knee_max_deg * kDegree;
  writer.link(name + "_HIP", sphere(kHipRadius_m), Vector3d::Zero(), "dark");
  writer.link(name + "_THIGH", cylinder(params.thigh_m), {0.0, 0.0, -0.5 * params.thigh_m}, "red");
  writer.link(name + "_SHANK", cylinder(params.shank_m), {0.0, 0.0, -0.5 * params.shank_m}, "dark");
  writer.link(name + "_FOOT", sphere(kFootRadius_m), Vector3d::Zero(), "dark");
  writer.revolute(name + "_HAA", base_link, name + "_HIP", leg.hip(), "1 0 0", -abduction,
                  abduction);
  writer.revolute(name + "_HFE", name + "_HIP", name + "_THIGH", leg.root() - leg.hip(), "0 1 0",
                  -flexion, flexion);
  writer.revolute(name + "_KFE", name + "_THIGH", name + "_SHANK", {0.0, 0.0, -params.thigh_m},
                  "0 1 0", is_front ? -bend_max : bend_min, is_front ? -bend_min : bend_max);
  writer.fixed(name + "_SOLE", name + "_SHANK", name + "_FOOT", {0.0, 0.0, -params.shank_m});
}

}  // namespace

std::string walkerUrdf(const WalkerParams& params, const std::string& base_link) {
  Writer writer;
  writer.colour("red", "0.70 0.10 0.08 1");
  writer.colour("dark", "0.18 0.18 0.20 1");
  writer.link(base_link, "<box size=\"" + Writer::numbers(params.trunk_m) + "\"/>",
              Vector3d::Zero(), "red");
  for (std::size_t k = 0; k < kLegs; ++k) addLeg(params, k, base_link, writer);
  return writer.robot();
}

}  // namespace spelunk::sim
