#include "spelunk/planners/baselines/nbvp_params.h"

namespace spelunk::planners::baselines {

std::vector<std::string> NbvpParams::problems() const {
  std::vector<std::string> problems;
  if (give_up_vertices < max_vertices)
    problems.push_back("give_up_vertices must be at least max_vertices");
  if (edge_length_min_m >= edge_length_max_m)
    problems.push_back("edge_length_min_m must be less than edge_length_max_m");
  if (samples != "explored" && samples != "box")
    problems.push_back("samples = '" + samples + "': write explored or box");
  return problems;
}

}  // namespace spelunk::planners::baselines
