#include "spelunk/sim/world_events.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

constexpr double kSpacing_m = 0.25;  // of the robot's way; its length is counted in these steps
constexpr double kWalking_mps = 1.2;
constexpr double kKeptAway_m = 1.5;  // from the robot's and its start's centre
const Eigen::Vector3d kFall_m(4.0, 4.0, 5.0);
const Eigen::Vector3d kPerson_m(0.6, 0.6, 1.8);

AxisAlignedBox movedTo(const AxisAlignedBox& box, const Eigen::Vector3d& place) {
  return {box.min + place, box.max + place};
}

double distanceTo(const AxisAlignedBox& box, const Eigen::Vector3d& point) {
  return (point - point.cwiseMax(box.min).cwiseMin(box.max)).norm();
}

/// Where a ray enters a box; none if it passes by. From within it does so at once.
std::optional<float> entry(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                           const AxisAlignedBox& box) {
  float from = 0.0F;
  float to = 1e9F;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = static_cast<float>(box.min[axis]) - origin[axis];
    const float high = static_cast<float>(box.max[axis]) - origin[axis];
    if (direction[axis] == 0.0F) {
      if (low > 0.0F || high < 0.0F) return std::nullopt;
      continue;
    }
    const float a = low / direction[axis];
    const float b = high / direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (from > to) return std::nullopt;
  return from;
}

}  // namespace

WorldEvents::WorldEvents(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) events_.push_back(eventFrom(text));
}

WorldEvents::Event WorldEvents::eventFrom(const std::string& text) {
  std::istringstream words(text);
  std::string kind;
  words >> kind;
  std::vector<double> numbers;
  for (double number = 0.0; words >> number;) numbers.push_back(number);
  const bool is_known = kind == "fall" || kind == "person";
  const bool is_placed = kind == "fall" && numbers.size() == 7;
  const bool is_whole =
      words.eof() && std::all_of(numbers.begin(), numbers.end(),
                                 [](double number) { return std::isfinite(number); });
  if (!is_known || !is_whole || (numbers.size() != 2 && !is_placed))
    throw OutsideError("sim.events: '" + text +
                       "' is no event; write 'fall T D', 'person T D' (seconds, metres back along "
                       "the robot's way) or 'fall T X Y Z SX SY SZ'");
  Event event;
  event.walks = kind == "person";
  event.from_s = numbers[0];
  event.behind_m = numbers[1];
  event.is_placed = is_placed;
  event.box = boxAround(Eigen::Vector3d::Zero(), event.walks ? kPerson_m : kFall_m);
  if (is_placed)
    event.box =
        boxAround({numbers[1], numbers[2], numbers[3]}, {numbers[4], numbers[5], numbers[6]});
  return event;
}

Eigen::Vector3d WorldEvents::placeAt(double arc_m) const {
  const auto i = static_cast<std::size_t>(std::max(0.0, arc_m / kSpacing_m));
  return way_[std::min(i, way_.size() - 1)];
}

void WorldEvents::appear(Event& event, const Eigen::Vector3d& robot_at) {
  const double flown_m = kSpacing_m * static_cast<double>(way_.size() - 1);
  if (!event.is_placed && flown_m < event.behind_m) return;
  event.arc_m = flown_m - event.behind_m;
  const AxisAlignedBox box = event.is_placed ? event.box : movedTo(event.box, placeAt(event.arc_m));
  event.is_there =
      distanceTo(box, robot_at) > kKeptAway_m && distanceTo(box, way_.front()) > kKeptAway_m;
}

void WorldEvents::update(double time_s, const Eigen::Vector3d& robot_at) {
  if (events_.empty()) return;
  if (way_.empty()) way_.push_back(robot_at);
  for (Eigen::Vector3d gap = robot_at - way_.back(); gap.norm() >= kSpacing_m;
       gap = robot_at - way_.back())
    way_.emplace_back(way_.back() + kSpacing_m * gap.normalized());
  boxes_.clear();
  for (Event& event : events_) {
    if (time_s < event.from_s) continue;
    if (!event.is_there) appear(event, robot_at);
    if (!event.is_there) continue;
    if (event.walks) event.arc_m -= kWalking_mps * (time_s - last_s_);
    if (event.arc_m < 0.0 && event.walks) continue;  // gone at the start of the way
    boxes_.push_back(event.is_placed ? event.box : movedTo(event.box, placeAt(event.arc_m)));
  }
  last_s_ = time_s;
}

void WorldEvents::shorten(const Eigen::Vector3f& origin,
                          const std::vector<Eigen::Vector3f>& directions,
                          std::vector<float>& ranges) const {
  for (const AxisAlignedBox& box : boxes_)
    for (std::size_t k = 0; k < directions.size(); ++k)
      if (const auto range = entry(origin, directions[k], box))
        ranges[k] = std::min(ranges[k], *range);
}

bool WorldEvents::touches(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) const {
  const AxisAlignedBox body = boxAround(centre, size);
  return std::any_of(boxes_.begin(), boxes_.end(), [&](const AxisAlignedBox& box) {
    return (body.min.array() <= box.max.array()).all() &&
           (body.max.array() >= box.min.array()).all();
  });
}

}  // namespace spelunk::sim
