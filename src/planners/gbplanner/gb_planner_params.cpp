#include "spelunk/planners/gbplanner/gb_planner_params.h"

namespace spelunk::planners::gbplanner {

std::vector<std::string> GbPlannerParams::problems() const {
  std::vector<std::string> problems;
  if (edge_length_min_m >= edge_length_max_m)
    problems.push_back("edge_length_min_m must be less than edge_length_max_m");
  if (connection_radius_m < edge_length_min_m)
    problems.push_back("connection_radius_m must be at least edge_length_min_m");
  if (prune_length_m > edge_length_max_m)
    problems.push_back("prune_length_m must not exceed edge_length_max_m");
  return problems;
}

}  // namespace spelunk::planners::gbplanner
