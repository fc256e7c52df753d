#include "spelunk/planners/gbplanner/plan_view.h"

#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/planners/gbplanner/exploration_gain.h"
#include "spelunk/planners/shared/visits.h"

namespace spelunk::planners::gbplanner {
namespace {

/// `box` where there is anything known within `margin`; never empty.
AxisAlignedBox knownPart(const AxisAlignedBox& box, const map::FrozenMap& map,
                         const Eigen::Vector3d& inside, const Eigen::Vector3d& margin) {
  AxisAlignedBox known = map.knownBounds();
  if (known.isEmpty()) known = boxAround(inside, Eigen::Vector3d::Zero());
  const AxisAlignedBox common = intersection(box, {known.min - margin, known.max + margin});
  return common.isEmpty() ? boxAround(inside, margin) : common;
}

/// Rays may run into unknown space sideways as far as they reach, but openings do not lead upwards.
Eigen::Vector3d rayMargin(const map::GainEvaluator& evaluator, const map::FrozenMap& map) {
  return {evaluator.reach(), evaluator.reach(), map.resolution()};
}

AxisAlignedBox grown(const AxisAlignedBox& box, const Eigen::Vector3d& margin) {
  return {box.min - margin, box.max + margin};
}

/// How far rays reach beyond a position.
Eigen::Vector3d gainMargin(const map::GainEvaluator& evaluator) {
  return {evaluator.reach(), evaluator.reach(), evaluator.reachInHeight()};
}

}  // namespace

PlanView::PlanView(const PlanRequest& request, const RobotModel& robot,
                   const GbPlannerParams& params, const map::GainEvaluator& evaluator,
                   const BodySpaces& bodies, map::KeptWindow& window)
    : request_(request),
      evaluator_(evaluator),
      visited_radius_m_(params.visited_radius_m),
      local_box_(
          intersection(boxAround(request.pose.position, params.local_box_m), request.bounds)),
      window_(window),
      space_([&exact = bodies.exact](const Eigen::Vector3d& a,
                                     const Eigen::Vector3d& b) { return exact.sweep(a, b); },
             robot.box_m, request.bounds, request.zones, groundUnder(*request.map, robot)),
      roomy_space_([&roomy = bodies.roomy](const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b) { return roomy.sweep(a, b); },
                   robot.box_m, request.bounds, request.zones) {
  bodies.exact.use(request.map);
  bodies.roomy.use(request.map);
}

void PlanView::prepareGains(const std::shared_ptr<const map::FrozenMap>& credible) {
  if (credible_ != nullptr) return;
  const AxisAlignedBox region = map::roundedOut(
      *credible, knownPart(grown(local_box_, gainMargin(evaluator_)), *request_.map,
                           request_.pose.position, rayMargin(evaluator_, *request_.map)));
  credible_ = &window_.over(credible, region);
  gain_bounds_ = intersection(region, request_.bounds);
}

double PlanView::gainAt(const Eigen::Vector3d& position, double yaw) const {
  require(credible_ != nullptr, "PlanView: prepareGains was not called");
  if (wasVisited(request_.trail, position, visited_radius_m_)) return 0.0;
  return evaluator_.evaluate(*credible_, position, yaw, gain_bounds_).unknown_m3;
}

double gainAnywhere(const PlanRequest& request, const map::FrozenMap& credible,
                    const map::GainEvaluator& evaluator, const Eigen::Vector3d& position,
                    double yaw) {
  const Eigen::Vector3d size = 2.0 * gainMargin(evaluator);
  const map::LocalWindow window(credible, knownPart(boxAround(position, size), *request.map,
                                                    position, rayMargin(evaluator, *request.map)));
  return evaluator.evaluate(window, position, yaw, request.bounds).unknown_m3;
}

}  // namespace spelunk::planners::gbplanner
