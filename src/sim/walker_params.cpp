#include "spelunk/sim/walker_params.h"

#include <sstream>

#include "spelunk/sim/leg_kinematics.h"

namespace spelunk::sim {
namespace {

/// Standing, the legs must be able to go this far up and down.
constexpr double kSpareReach_m = 0.05;

void addLegProblems(const WalkerParams& params, std::vector<std::string>& found) {
  const Leg leg(params, 0);
  const double hang = params.stand_height_m + params.hip_m.z();
  std::ostringstream text;
  if (hang + kSpareReach_m > leg.longest())
    text << "walker.stand_height_m = " << params.stand_height_m
         << " is out of the legs' reach: walker.thigh_m and walker.shank_m stretch to "
         << leg.longest() << " m and need " << kSpareReach_m
         << " m to spare; lower it or lengthen the legs";
  else if (hang - kSpareReach_m < leg.shortest())
    text << "walker.stand_height_m = " << params.stand_height_m
         << " is too low: walker.thigh_m and walker.shank_m fold to " << leg.shortest()
         << " m only; raise it, shorten the legs or raise walker.knee_max_deg";
  else if (!leg.anglesFor(leg.root() - Eigen::Vector3d(0.0, 0.0, hang)))
    text << "walker.flexion_max_deg = " << params.flexion_max_deg
         << " does not let the legs stand; raise it";
  if (!text.str().empty()) found.push_back(text.str());
}

}  // namespace

std::vector<std::string> WalkerParams::problems() const {
  std::vector<std::string> found;
  if (gait != "trot" && gait != "walk")
    found.push_back("walker.gait = '" + gait + "' must be trot or walk");
  if (gait == "walk" && duty_factor < 0.75)
    found.emplace_back("walker.duty_factor must be 0.75 or more for walker.gait walk");
  if (hip_m.x() <= 0.0 || hip_m.y() <= 0.0)
    found.emplace_back("walker.hip_m: the left front hip has x and y above 0");
  if (knee_min_deg >= knee_max_deg)
    found.emplace_back("walker.knee_min_deg must be below walker.knee_max_deg");
  else
    addLegProblems(*this, found);
  if (trunk_m.z() / 2.0 + 0.05 > stand_height_m)
    found.emplace_back(
        "walker.trunk_m: standing, the trunk must be 0.05 m above the ground; lower its height or "
        "raise walker.stand_height_m");
  return found;
}

Eigen::Vector3d trunkInertia(const WalkerParams& params) {
  const Eigen::Vector3d squared = params.trunk_m.cwiseProduct(params.trunk_m);
  return params.trunk_mass_kg / 12.0 *
         Eigen::Vector3d(squared.y() + squared.z(), squared.x() + squared.z(),
                         squared.x() + squared.y());
}

}  // namespace spelunk::sim
