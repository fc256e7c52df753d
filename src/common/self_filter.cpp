#include "spelunk/common/self_filter.h"

#include <algorithm>
#include <array>
#include <locale>
#include <optional>
#include <sstream>

namespace spelunk {
namespace {

constexpr std::size_t kNumbersOfBox = 6;

std::optional<double> numberOf(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (!(stream >> value) || stream.peek() != EOF) return std::nullopt;
  return value;
}

}  // namespace

SelfFilterBoxes selfFilterBoxes(const RobotModel& robot) {
  const std::vector<std::string>& texts = robot.self_filter_boxes_m;
  const auto complain = [&](const std::string& what) -> SelfFilterBoxes {
    return {{}, "robot '" + robot.name + "': self_filter_boxes_m " + what};
  };
  if (texts.size() % kNumbersOfBox != 0)
    return complain("has " + std::to_string(texts.size()) +
                    " numbers, wanted are six a box: centre x, y, z, size x, y, z");
  std::vector<double> numbers;
  for (const std::string& text : texts) {
    const auto number = numberOf(text);
    if (!number) return complain("holds '" + text + "', which is not a number");
    numbers.push_back(*number);
  }
  SelfFilterBoxes read;
  for (std::size_t i = 0; i < numbers.size(); i += kNumbersOfBox) {
    const Eigen::Vector3d size(numbers[i + 3], numbers[i + 4], numbers[i + 5]);
    if (size.minCoeff() <= 0.0)
      return complain("has a box of size " + toText(size) + ", sizes must be above 0");
    read.boxes.push_back(boxAround({numbers[i], numbers[i + 1], numbers[i + 2]}, size));
  }
  return read;
}

std::vector<Eigen::Vector3f> SelfFilter::without(std::vector<Eigen::Vector3f> points,
                                                 const Eigen::Isometry3d& T_base_sensor) const {
  if (boxes_.empty()) return points;
  const auto is_own = [&](const Eigen::Vector3f& point) {
    const Eigen::Vector3d p_base = T_base_sensor * point.cast<double>();
    return std::any_of(boxes_.begin(), boxes_.end(),
                       [&](const AxisAlignedBox& box) { return box.contains(p_base); });
  };
  points.erase(std::remove_if(points.begin(), points.end(), is_own), points.end());
  return points;
}

}  // namespace spelunk
