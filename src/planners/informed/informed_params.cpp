#include "spelunk/planners/informed/informed_params.h"

namespace spelunk::planners::informed {

std::vector<std::string> InformedParams::problems() const {
  std::vector<std::string> problems;
  if (sample_spacing_m > range_m) problems.push_back("sample_spacing_m must not exceed range_m");
  if (clearance_weight_branch < clearance_weight_void)
    problems.push_back("clearance_weight_branch must be at least clearance_weight_void");
  return problems;
}

}  // namespace spelunk::planners::informed
