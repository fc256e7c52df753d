#include "spelunk/planners/shared/frontier_view.h"

#include <algorithm>
#include <cmath>

namespace spelunk::planners {
namespace {

/// Rays as long as the range, and so dense that neighbours end a voxel apart.
std::vector<SensorModel> withRange(std::vector<SensorModel> sensors, double range_m,
                                   double resolution_m) {
  constexpr double kDegree = M_PI / 180.0;
  for (SensorModel& sensor : sensors) {
    sensor.gain_range_m = std::min(gainRange(sensor), range_m);
    sensor.gain_resolution_deg =
        std::clamp(resolution_m / sensor.gain_range_m / kDegree, 1.0, sensor.gain_resolution_deg);
    sensor.gain_row_angle_deg = 0.0;
  }
  return sensors;
}

}  // namespace

FrontierView::FrontierView(const RobotModel& robot, double resolution_m,
                           const FrontierViewParams& params)
    : params_(params),
      evaluator_(withRange(robot.sensor_models, params.range_m, resolution_m), resolution_m,
                 map::GainCounting::kDistinct),
      filter_(params.credibility) {}

void FrontierView::look(const std::shared_ptr<const map::FrozenMap>& map) {
  credible_ = filter_.of(map);
  frontier_.update(credible_);
}

void FrontierView::forget() {
  filter_ = map::CredibleMap(params_.credibility);
  credible_.reset();
  frontier_ = {};
}

map::VolumetricGain FrontierView::seenFrom(const Eigen::Vector3d& position, double yaw,
                                           const AxisAlignedBox& bounds) const {
  const Eigen::Vector3d centre = credible_->centreOf(credible_->indexOf(position));
  const double side = 2.0 * evaluator_.reach();
  const map::LocalWindow window(*credible_, boxAround(centre, Eigen::Vector3d::Constant(side)));
  return evaluator_.evaluate(window, position, yaw, bounds);
}

double FrontierView::clearanceAt(const map::FrozenMap& map, const Eigen::Vector3d& place,
                                 double limit_m) {
  const map::LocalWindow window(map, boxAround(place, Eigen::Vector3d::Constant(2.0 * limit_m)));
  double nearest = limit_m * limit_m;
  const map::VoxelIndex& size = window.size();
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const map::VoxelIndex local(x, y, z);
        if (window.cells()[window.offsetOf(local)] !=
            static_cast<std::uint8_t>(map::Occupancy::kOccupied))
          continue;
        nearest =
            std::min(nearest, (window.centreOf(window.origin() + local) - place).squaredNorm());
      }
  return std::sqrt(nearest);
}

}  // namespace spelunk::planners
