#include "spelunk/planners/gbplanner/plan_view.h"

#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/planners/gbplanner/exploration_gain.h"

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

/// A voxel beyond what is known: as good as more where unknown space is not passed.
Eigen::Vector3d oneVoxel(const map::FrozenMap& map) {
  return Eigen::Vector3d::Constant(map.resolution());
}

/// Rays may run into unknown space sideways as far as they reach, but openings do not lead upwards.
Eigen::Vector3d rayMargin(const map::GainEvaluator& evaluator, const map::FrozenMap& map) {
  return {evaluator.reach(), evaluator.reach(), map.resolution()};
}

AxisAlignedBox grown(const AxisAlignedBox& box, const Eigen::Vector3d& margin) {
  return {box.min - margin, box.max + margin};
}

/// How far rays reach beyond a position; the fields of view are flat.
Eigen::Vector3d gainMargin(const map::GainEvaluator& evaluator) {
  constexpr double kSteepest = 0.3;  // tangent of the steepest rays that matter beyond the box
  return {evaluator.reach(), evaluator.reach(), kSteepest * evaluator.reach()};
}

}  // namespace

PlanView::PlanView(const PlanRequest& request, const RobotModel& robot,
                   const GbPlannerParams& params, const map::GainEvaluator& evaluator,
                   const Eigen::Vector3d& box_m)
    : request_(request),
      robot_(robot),
      params_(params),
      evaluator_(evaluator),
      local_box_(intersection(boxAround(request.pose.position, box_m), request.bounds)),
      window_(*request.map, knownPart(grown(local_box_, robot.box_m + params.safety_margin_m),
                                      *request.map, request.pose.position, oneVoxel(*request.map))),
      inflated_(window_, robot.box_m),
      checker_(std::make_unique<navigation::SegmentChecker>(request.map, robot.box_m)),
      ground_rules_(terrain::GroundRules::of(robot, request.map->resolution())),
      local_space_([this](const Eigen::Vector3d& p,
                          const Eigen::Vector3d& q) { return inflated_.sweep(p, q); },
                   robot.box_m, request.bounds, request.zones, groundIn(window_)),
      roomy_space_([this](const Eigen::Vector3d& p,
                          const Eigen::Vector3d& q) { return inflated_roomy_->sweep(p, q); },
                   robot.box_m, request.bounds, request.zones),
      global_space_([this](const Eigen::Vector3d& a,
                           const Eigen::Vector3d& b) { return checker_->sweep(a, b); },
                    robot.box_m, request.bounds, request.zones, groundIn(*request.map)) {}

template <class Map>
std::optional<GroundUnder> PlanView::groundIn(const Map& map) const {
  if (kindOf(robot_) != RobotKind::kLegged) return std::nullopt;
  return GroundUnder{ground_rules_, terrain::lookupIn(map)};
}

void PlanView::prepareSearch(const map::FrozenMap& credible) {
  if (credible_) return;
  inflated_roomy_.emplace(window_, robot_.box_m + 2.0 * params_.safety_margin_m);
  credible_.emplace(credible,
                    knownPart(grown(local_box_, gainMargin(evaluator_)), *request_.map,
                              request_.pose.position, rayMargin(evaluator_, *request_.map)));
}

double PlanView::gainAt(const Eigen::Vector3d& position, double yaw) const {
  require(credible_.has_value(), "PlanView: prepareSearch was not called");
  if (wasVisited(request_.trail, position, params_.visited_radius_m)) return 0.0;
  return evaluator_.evaluate(*credible_, position, yaw, request_.bounds).unknown_m3;
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
