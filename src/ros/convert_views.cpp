#include <sensor_msgs/PointField.h>

#include <array>
#include <cstring>

#include "spelunk/ros/convert.h"

namespace spelunk::bridge {

PlannerStatus toMsg(const mission::MissionStatus& status, const std::string& frame,
                    const ::ros::Time& stamp) {
  PlannerStatus message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.state = mission::toText(status.state);
  message.last_status = status.last_plan_status;
  message.reason = status.end_reason.empty() ? status.reason : status.end_reason;
  message.mission_time_s = status.time_s;
  message.explored_volume_m3 = status.known_volume_m3;
  message.remaining_s = status.remaining_s;
  message.way_home_s = status.way_home_s;
  message.margin_s = status.margin_s;
  message.distance_m = status.distance_m;
  message.plans = static_cast<std::uint32_t>(status.plans);
  message.last_plan_ms = status.last_stats.total_ms;
  message.last_map_update_ms = status.last_map_update_ms;
  message.best_gain = status.last_stats.best_gain;
  message.gain_threshold = status.last_stats.gain_threshold;
  return message;
}

Graph toMsg(const planners::PlannerGraph& graph, const std::string& frame,
            const ::ros::Time& stamp) {
  Graph message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  for (const planners::GraphLayer& layer : graph.layers) {
    const auto first = static_cast<std::uint32_t>(message.vertices.size());
    const auto number = static_cast<std::uint32_t>(message.layers.size());
    message.layers.push_back(layer.name);
    for (const planners::GraphVertex& vertex : layer.vertices) {
      message.layer_of_vertex.push_back(number);
      message.vertices.push_back(toMsg(vertex.position));
      message.gain_m3.push_back(vertex.gain_m3);
      message.is_frontier.push_back(vertex.is_frontier);
    }
    for (const auto& [from, to] : layer.edges) {
      message.edge_from.push_back(first + from);
      message.edge_to.push_back(first + to);
    }
  }
  return message;
}

sensor_msgs::PointCloud2 toMsg(const std::vector<Eigen::Vector3f>& points, const std::string& frame,
                               const ::ros::Time& stamp) {
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  sensor_msgs::PointCloud2 message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.height = 1;
  message.width = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::PointField field;
    field.name = kNames[axis];
    field.offset = axis * static_cast<std::uint32_t>(sizeof(float));
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    message.fields.push_back(field);
  }
  message.point_step = sizeof(Eigen::Vector3f);
  message.row_step = message.point_step * message.width;
  message.is_dense = true;
  message.data.resize(message.row_step);
  if (!points.empty()) std::memcpy(message.data.data(), points.data(), message.data.size());
  return message;
}

}  // namespace spelunk::bridge
