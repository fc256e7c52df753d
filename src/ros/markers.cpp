#include "spelunk/ros/markers.h"

#include <cmath>
#include <utility>

#include "spelunk/ros/convert.h"

namespace spelunk::bridge {
namespace {

using visualization::Colour;
using visualization::Element;
using visualization::Shape;
using visualization_msgs::Marker;

int typeOf(Shape shape) {
  switch (shape) {
    case Shape::kPoints:
      return Marker::POINTS;
    case Shape::kCubes:
      return Marker::CUBE_LIST;
    case Shape::kSpheres:
      return Marker::SPHERE_LIST;
    case Shape::kBox:
      return Marker::CUBE;
    case Shape::kLineStrip:
      return Marker::LINE_STRIP;
    case Shape::kLineList:
      return Marker::LINE_LIST;
    case Shape::kText:
      return Marker::TEXT_VIEW_FACING;
  }
  return Marker::POINTS;
}

std_msgs::ColorRGBA colourMsg(const Colour& colour) {
  std_msgs::ColorRGBA message;
  message.r = colour.r;
  message.g = colour.g;
  message.b = colour.b;
  message.a = colour.a;
  return message;
}

Marker markerOf(const Element& element) {
  Marker marker;
  marker.ns = element.layer;
  marker.type = typeOf(element.shape);
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = element.size_m;
  marker.color = colourMsg(element.colours.front());
  if (element.shape == Shape::kBox || element.shape == Shape::kText) {
    marker.pose = toMsg(Pose{element.points.front(), element.yaw});
    marker.text = element.text;
  }
  if (element.shape == Shape::kBox) {
    marker.scale.x = element.extents_m.x();
    marker.scale.y = element.extents_m.y();
    marker.scale.z = element.extents_m.z();
    return marker;
  }
  if (element.shape == Shape::kText) return marker;
  for (const Eigen::Vector3d& point : element.points) marker.points.push_back(toMsg(point));
  if (element.colours.size() > 1)
    for (const Colour& colour : element.colours) marker.colors.push_back(colourMsg(colour));
  return marker;
}

}  // namespace

visualization_msgs::MarkerArray MarkerBuilder::build(const visualization::Scene& scene,
                                                     const std::string& frame,
                                                     const ::ros::Time& stamp) {
  visualization_msgs::MarkerArray array;
  std::map<std::string, int> now_shown;
  for (const Element& element : scene.elements()) {
    Marker marker = markerOf(element);
    marker.id = now_shown[element.layer]++;
    array.markers.push_back(std::move(marker));
  }
  for (const auto& [layer, count] : shown_) {
    for (int id = now_shown[layer]; id < count; ++id) {
      Marker gone;
      gone.ns = layer;
      gone.id = id;
      gone.action = Marker::DELETE;
      array.markers.push_back(gone);
    }
  }
  for (Marker& marker : array.markers) {
    marker.header.frame_id = frame;
    marker.header.stamp = stamp;
  }
  shown_ = std::move(now_shown);
  return array;
}

}  // namespace spelunk::bridge
