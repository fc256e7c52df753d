#include "spelunk/planners/informed/informed_params.h"

#include <algorithm>

#include "spelunk/planners/shared/robot_fit.h"

namespace spelunk::planners::informed {
namespace {

/// Half the width of a drift; from the middle of a small room the rest of it is not visited yet.
constexpr double kVisitedRadius_m = 1.0;

}  // namespace

InformedParams InformedParams::resolvedFor(const RobotModel& robot) const {
  if (range_m > 0.0) return *this;
  InformedParams resolved = *this;
  resolved.range_m = denseRange(robot);
  if (resolved.range_m <= 0.0) resolved.range_m = kPaperRange_m;
  const double scale = resolved.range_m / kPaperRange_m;
  resolved.sample_spacing_m *= scale;
  resolved.length_decay /= scale;
  resolved.gain_min_m3 *= scale;
  if (resolved.visited_radius_m <= 0.0 && seesAllAround(robot))
    resolved.visited_radius_m = kVisitedRadius_m;
  return resolved;
}

std::vector<std::string> InformedParams::problems() const {
  std::vector<std::string> problems;
  const double range = range_m > 0.0 ? range_m : kPaperRange_m;
  if (sample_spacing_m > range)
    problems.push_back("sample_spacing_m = " + toText(sample_spacing_m) +
                       " must not exceed range_m = " + toText(range));
  if (clearance_weight_branch < clearance_weight_void)
    problems.push_back(
        "clearance_weight_branch = " + toText(clearance_weight_branch) +
        " must be at least clearance_weight_void = " + toText(clearance_weight_void));
  return problems;
}

std::vector<std::string> InformedParams::problemsFor(const RobotModel& robot,
                                                     double resolution_m) const {
  const InformedParams all = resolvedFor(robot);
  return joined(joined(edgeProblems("range_m", all.range_m, resolution_m),
                       sightProblems("range_m", all.range_m, robot)),
                sightProblems("visited_radius_m", visited_radius_m, robot));
}

}  // namespace spelunk::planners::informed
