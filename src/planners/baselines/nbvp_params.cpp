#include "spelunk/planners/baselines/nbvp_params.h"

namespace spelunk::planners::baselines {

std::vector<std::string> NbvpParams::problems() const {
  if (give_up_vertices >= max_vertices) return {};
  return {"give_up_vertices must be at least max_vertices"};
}

}  // namespace spelunk::planners::baselines
