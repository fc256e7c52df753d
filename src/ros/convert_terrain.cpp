#include "spelunk/ros/convert_terrain.h"

#include <sensor_msgs/PointField.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "spelunk/visualization/draw_terrain.h"

namespace spelunk::bridge {
namespace {

using terrain::CellIndex;
using terrain::GroundClass;

constexpr std::int8_t kUnknownCell = -1;
constexpr std::int8_t kBlockedCell = 100;
constexpr double kWorstCell = 98.0;  ///< 99 has a meaning of its own in ROS costmaps.

/// One point as it lies in the cloud's data.
struct Record {
  float x, y, z;
  std::uint32_t rgb;
  float traversability, variance_m2;
};
constexpr std::array<const char*, 6> kFieldNames{"x",          "y", "z", "rgb", "traversability",
                                                 "variance_m2"};
static_assert(sizeof(Record) == kFieldNames.size() * sizeof(float));

/// The lowest covered cell and how many are covered along an axis (0: none).
struct Covered {
  CellIndex first = CellIndex::Zero();
  int side = 0;
};

/// Coverage is a square in the middle of the window, so its diagonal tells all.
Covered coveredBy(const terrain::TerrainView& view) {
  Covered covered;
  for (int i = 0; i < view.grid().side(); ++i) {
    const CellIndex cell = view.grid().first().array() + i;
    if (!view.covers(cell)) continue;
    if (covered.side++ == 0) covered.first = cell;
  }
  return covered;
}

std::int8_t costOf(const terrain::TerrainView& view, const CellIndex& cell) {
  const GroundClass ground = view.classAt(cell);
  if (ground == GroundClass::kUnknown) return kUnknownCell;
  if (ground != GroundClass::kTraversable) return kBlockedCell;
  const double value = std::clamp(view.valueAt(cell).value_or(0.0), 0.0, 1.0);
  return static_cast<std::int8_t>(std::lround(kWorstCell * (1.0 - value)));
}

double medianHeight(const std::vector<terrain::TerrainPoint>& points) {
  std::vector<double> heights;
  for (const terrain::TerrainPoint& point : points)
    if (point.ground_class != GroundClass::kDrop) heights.push_back(point.position.z());
  if (heights.empty()) return 0.0;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

std::uint32_t packed(const visualization::Colour& colour) {
  const auto byte = [](float share) {
    return static_cast<std::uint32_t>(std::lround(255.0F * share));
  };
  return byte(colour.r) << 16U | byte(colour.g) << 8U | byte(colour.b);
}

Record recordOf(const terrain::TerrainPoint& point) {
  const Eigen::Vector3f at = point.position.cast<float>();
  const float value = point.ground_class == GroundClass::kUnknown
                          ? std::numeric_limits<float>::quiet_NaN()
                          : static_cast<float>(point.value);
  return {at.x(), at.y(),
          at.z(), packed(visualization::terrainColour(point)),
          value,  static_cast<float>(point.variance_m2)};
}

}  // namespace

nav_msgs::OccupancyGrid traversabilityMsg(const terrain::TerrainView& view,
                                          const std::string& frame, const ::ros::Time& stamp) {
  const Covered covered = coveredBy(view);
  const double cell_m = view.grid().cell();
  nav_msgs::OccupancyGrid message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.info.map_load_time = stamp;
  message.info.resolution = static_cast<float>(cell_m);
  message.info.width = message.info.height = static_cast<std::uint32_t>(covered.side);
  message.info.origin.position.x = covered.first.x() * cell_m;
  message.info.origin.position.y = covered.first.y() * cell_m;
  message.info.origin.position.z = medianHeight(view.points());
  message.info.origin.orientation.w = 1.0;
  message.data.reserve(static_cast<std::size_t>(covered.side) * covered.side);
  for (int y = 0; y < covered.side; ++y)
    for (int x = 0; x < covered.side; ++x)
      message.data.push_back(costOf(view, covered.first + CellIndex(x, y)));
  return message;
}

sensor_msgs::PointCloud2 elevationMsg(const terrain::TerrainView& view, const std::string& frame,
                                      const ::ros::Time& stamp) {
  std::vector<Record> records;
  for (const terrain::TerrainPoint& point : view.points()) records.push_back(recordOf(point));
  sensor_msgs::PointCloud2 message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.height = 1;
  message.width = static_cast<std::uint32_t>(records.size());
  for (const char* name : kFieldNames) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(message.fields.size() * sizeof(float));
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    message.fields.push_back(field);
  }
  message.point_step = sizeof(Record);
  message.row_step = message.point_step * message.width;
  message.is_dense = false;
  message.data.resize(message.row_step);
  if (!records.empty()) std::memcpy(message.data.data(), records.data(), message.data.size());
  return message;
}

}  // namespace spelunk::bridge
