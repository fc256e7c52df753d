#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <string>

#include "spelunk/visualization/scene.h"

namespace spelunk::bridge {

/// Turns scenes into marker arrays, one namespace a layer, and deletes markers of the scene before
/// that the new one does not replace.
class MarkerBuilder {
 public:
  [[nodiscard]] visualization_msgs::MarkerArray build(const visualization::Scene& scene,
                                                      const std::string& frame,
                                                      const ::ros::Time& stamp);

 private:
  std::map<std::string, int> shown_;  ///< Markers now shown, by namespace.
};

}  // namespace spelunk::bridge
