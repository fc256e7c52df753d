#include <sensor_msgs/PointField.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "spelunk/ros/cloud_filter.h"

namespace spelunk::bridge {
namespace {

using sensor_msgs::PointField;
using Points = std::vector<Eigen::Vector3f>;

/// Bytes from point to point and from row to row.
struct Steps {
  std::uint64_t point = 0;
  std::uint64_t row = 0;
};

/// Where the coordinates of a point lie in its record.
struct Layout {
  std::array<std::uint32_t, 3> offset{};
  std::array<bool, 3> is_double{};
  bool is_swapped = false;  ///< The bytes of a number come in the other order than here.
};

std::string namesOf(const std::vector<PointField>& fields) {
  std::string names;
  for (const PointField& field : fields) names += (names.empty() ? "'" : ", '") + field.name + "'";
  return names.empty() ? "none" : names;
}

/// What the message says where that fits its data; else what the size of the data leaves as the
/// only possibility: points without gaps, rows of the same length.
FromMsg<Steps> stepsOf(const sensor_msgs::PointCloud2& cloud) {
  const std::uint64_t size = cloud.data.size();
  const std::uint64_t count = std::uint64_t{cloud.width} * cloud.height;
  Steps steps{cloud.point_step, cloud.row_step};
  if (steps.point == 0 && size % count == 0) steps.point = size / count;
  const std::uint64_t row = cloud.width * steps.point;
  const auto fits = [&] {
    return steps.row >= row && (cloud.height - 1) * steps.row + row <= size;
  };
  if (!fits() && size % cloud.height == 0) steps.row = size / cloud.height;
  if (steps.point > 0 && fits()) return {steps, ""};
  return {std::nullopt,
          "announces more points than its data holds: width " + std::to_string(cloud.width) +
              " x height " + std::to_string(cloud.height) + " at point_step " +
              std::to_string(cloud.point_step) + " and row_step " + std::to_string(cloud.row_step) +
              " need " + std::to_string(row * cloud.height) + " bytes, data has " +
              std::to_string(size) +
              ": its driver must set these four numbers to what it sends (row_step is width x "
              "point_step)"};
}

FromMsg<Layout> layoutOf(const sensor_msgs::PointCloud2& cloud, const Steps& steps) {
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  Layout layout;
  layout.is_swapped = cloud.is_bigendian != 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const PointField* found = nullptr;
    for (const PointField& field : cloud.fields)
      if (field.name == kNames[axis]) found = &field;
    if (!found)
      return {std::nullopt, std::string("has no field '") + kNames[axis] + "', its fields are " +
                                namesOf(cloud.fields) +
                                ": remap 'pointcloud' to a topic with x, y and z in metres"};
    if (found->datatype != PointField::FLOAT32 && found->datatype != PointField::FLOAT64)
      return {std::nullopt, "has field '" + found->name + "' of datatype " +
                                std::to_string(found->datatype) +
                                ", wanted is FLOAT32 (7) or FLOAT64 (8) in metres: have its driver "
                                "send one of these"};
    layout.offset[axis] = found->offset;
    layout.is_double[axis] = found->datatype == PointField::FLOAT64;
    const std::size_t size = layout.is_double[axis] ? sizeof(double) : sizeof(float);
    if (found->offset + size > steps.point)
      return {std::nullopt, "has field '" + found->name + "' at bytes " +
                                std::to_string(found->offset) + " to " +
                                std::to_string(found->offset + size) + ", beyond its point_step " +
                                std::to_string(steps.point) +
                                ": its driver must set offset and point_step to what it sends"};
  }
  return {layout, ""};
}

template <class Number>
double numberAt(const std::uint8_t* bytes, bool is_swapped) {
  std::array<std::uint8_t, sizeof(Number)> raw{};
  std::memcpy(raw.data(), bytes, sizeof(Number));
  if (is_swapped) std::reverse(raw.begin(), raw.end());
  Number value = 0;
  std::memcpy(&value, raw.data(), sizeof(Number));
  return static_cast<double>(value);
}

double coordinateAt(const std::uint8_t* record, const Layout& layout, std::size_t axis) {
  const std::uint8_t* bytes = record + layout.offset[axis];
  return layout.is_double[axis] ? numberAt<double>(bytes, layout.is_swapped)
                                : numberAt<float>(bytes, layout.is_swapped);
}

}  // namespace

FromMsg<Points> pointsFromMsg(const sensor_msgs::PointCloud2& cloud,
                              const Eigen::Isometry3d& T_sensor_cloud) {
  if (cloud.width == 0 || cloud.height == 0)
    return {std::nullopt, "holds no points (width " + std::to_string(cloud.width) + ", height " +
                              std::to_string(cloud.height) +
                              "): check that the sensor sees something and its driver's filters"};
  const auto steps = stepsOf(cloud);
  if (!steps.value) return {std::nullopt, steps.problem};
  const auto layout = layoutOf(cloud, *steps.value);
  if (!layout.value) return {std::nullopt, layout.problem};

  Points points;
  points.reserve(std::size_t{cloud.width} * cloud.height);
  for (std::uint32_t row = 0; row < cloud.height; ++row) {
    const std::uint8_t* record = cloud.data.data() + row * steps.value->row;
    for (std::uint32_t column = 0; column < cloud.width; ++column, record += steps.value->point) {
      const Eigen::Vector3d there(coordinateAt(record, *layout.value, 0),
                                  coordinateAt(record, *layout.value, 1),
                                  coordinateAt(record, *layout.value, 2));
      const Eigen::Vector3f point = (T_sensor_cloud * there).cast<float>();
      if (point.allFinite()) points.push_back(point);
    }
  }
  if (points.empty())
    return {std::nullopt, "holds " + std::to_string(std::size_t{cloud.width} * cloud.height) +
                              " points, none of them finite (all NaN): check that the sensor sees "
                              "something nearer than its longest range"};
  return {std::move(points), ""};
}

double coordinateError(const sensor_msgs::PointCloud2& cloud, double at_m) {
  const bool is_exact =
      std::none_of(cloud.fields.begin(), cloud.fields.end(), [](const PointField& field) {
        return field.datatype == PointField::FLOAT32 &&
               (field.name == "x" || field.name == "y" || field.name == "z");
      });
  if (is_exact) return 0.0;
  const auto at = static_cast<float>(at_m);
  return 0.5 * (std::nextafter(at, std::numeric_limits<float>::infinity()) - at);
}

}  // namespace spelunk::bridge
