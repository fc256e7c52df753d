#include <sensor_msgs/PointField.h>

#include <array>
#include <cstring>

#include "spelunk/ros/cloud_filter.h"

namespace spelunk::bridge {
namespace {

using sensor_msgs::PointField;
using Points = std::vector<Eigen::Vector3f>;

/// Where the coordinates of a point lie in its record.
struct Layout {
  std::array<std::uint32_t, 3> offset{};
  std::array<bool, 3> is_double{};
};

FromMsg<Layout> layoutOf(const sensor_msgs::PointCloud2& cloud) {
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  Layout layout;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const PointField* found = nullptr;
    for (const PointField& field : cloud.fields)
      if (field.name == kNames[axis]) found = &field;
    if (!found) return {std::nullopt, std::string("has no field '") + kNames[axis] + "'"};
    if (found->datatype != PointField::FLOAT32 && found->datatype != PointField::FLOAT64)
      return {std::nullopt, "field '" + found->name + "' must be float32 or float64"};
    layout.offset[axis] = found->offset;
    layout.is_double[axis] = found->datatype == PointField::FLOAT64;
    const std::size_t size = layout.is_double[axis] ? sizeof(double) : sizeof(float);
    if (found->offset + size > cloud.point_step)
      return {std::nullopt, "field '" + found->name + "' lies beyond point_step"};
  }
  return {layout, ""};
}

float coordinateAt(const std::uint8_t* record, const Layout& layout, std::size_t axis) {
  if (layout.is_double[axis]) {
    double value = 0.0;
    std::memcpy(&value, record + layout.offset[axis], sizeof(value));
    return static_cast<float>(value);
  }
  float value = 0.0F;
  std::memcpy(&value, record + layout.offset[axis], sizeof(value));
  return value;
}

std::string problemOf(const sensor_msgs::PointCloud2& cloud) {
  if (cloud.width == 0 || cloud.height == 0) return "holds no points";
  if (cloud.is_bigendian) return "is big-endian, which is not read";
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  const std::uint64_t last_row = std::uint64_t{cloud.height - 1} * cloud.row_step;
  const bool rows_overlap = cloud.height > 1 && cloud.row_step < row;
  if (rows_overlap || last_row + row > cloud.data.size())
    return "announces more points than its data holds";
  return "";
}

}  // namespace

FromMsg<Points> pointsFromMsg(const sensor_msgs::PointCloud2& cloud) {
  const std::string problem = problemOf(cloud);
  if (!problem.empty()) return {std::nullopt, problem};
  const auto layout = layoutOf(cloud);
  if (!layout.value) return {std::nullopt, layout.problem};

  Points points;
  points.reserve(std::size_t{cloud.width} * cloud.height);
  for (std::uint32_t row = 0; row < cloud.height; ++row) {
    const std::uint8_t* record = cloud.data.data() + std::size_t{row} * cloud.row_step;
    for (std::uint32_t column = 0; column < cloud.width; ++column, record += cloud.point_step) {
      const Eigen::Vector3f point(coordinateAt(record, *layout.value, 0),
                                  coordinateAt(record, *layout.value, 1),
                                  coordinateAt(record, *layout.value, 2));
      if (point.allFinite()) points.push_back(point);
    }
  }
  if (points.empty()) return {std::nullopt, "holds no finite point (all NaN)"};
  return {std::move(points), ""};
}

}  // namespace spelunk::bridge
