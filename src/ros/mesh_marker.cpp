#include "spelunk/ros/mesh_marker.h"

#include <algorithm>

#include "spelunk/ros/convert.h"

namespace spelunk::bridge {

visualization_msgs::Marker meshMarker(const sim::WorldMesh& mesh, const std::string& frame) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.ns = "mesh";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.a = 1.0F;
  const AxisAlignedBox bounds = mesh.bounds();
  const double height = std::max(1e-6, bounds.size().z());
  marker.points.reserve(3 * mesh.triangles.size());
  marker.colors.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (const int corner : triangle) {
      const Eigen::Vector3d vertex = mesh.vertices[static_cast<std::size_t>(corner)].cast<double>();
      const auto share = static_cast<float>((vertex.z() - bounds.min.z()) / height);
      std_msgs::ColorRGBA colour;
      colour.r = 0.35F + 0.4F * share;
      colour.g = 0.32F + 0.38F * share;
      colour.b = 0.3F + 0.35F * share;
      colour.a = 1.0F;
      marker.points.push_back(toMsg(vertex));
      marker.colors.push_back(colour);
    }
  }
  return marker;
}

}  // namespace spelunk::bridge
