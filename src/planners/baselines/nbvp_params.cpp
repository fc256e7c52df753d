#include "spelunk/planners/baselines/nbvp_params.h"

#include "spelunk/planners/shared/robot_fit.h"

namespace spelunk::planners::baselines {

NbvpParams NbvpParams::resolvedFor(const RobotModel& robot) const {
  NbvpParams resolved = *this;
  resolved.gain_min_m3 = passableThreshold(gain_min_m3, kPlaceShare, robot);
  sayLowered("nbvp.gain_min_m3", gain_min_m3, resolved.gain_min_m3, robot);
  return resolved;
}

std::vector<std::string> NbvpParams::problems() const {
  std::vector<std::string> problems;
  if (give_up_vertices < max_vertices)
    problems.push_back("give_up_vertices = " + toText(give_up_vertices) +
                       " must be at least max_vertices = " + toText(max_vertices));
  if (edge_length_min_m >= edge_length_max_m)
    problems.push_back("edge_length_min_m = " + toText(edge_length_min_m) +
                       " must be less than edge_length_max_m = " + toText(edge_length_max_m));
  if (samples != "explored" && samples != "box")
    problems.push_back("samples = '" + samples + "': write explored or box");
  return problems;
}

std::vector<std::string> NbvpParams::problemsFor(const RobotModel& /*robot*/,
                                                 double resolution_m) const {
  return edgeProblems("edge_length_max_m", edge_length_max_m, resolution_m);
}

}  // namespace spelunk::planners::baselines
