#include "spelunk/sim/mesh_size.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "spelunk/sim/start_check.h"

namespace spelunk::sim {
namespace {

constexpr double kHighestHall_m = 100.0;  // higher than any stope; in centimetres a drift of 1 m
constexpr double kLowestPassage_m = 0.3;  // lower than any robot
constexpr double kUprightRatio = 2.0;     // so much higher than wide: lying on its side?

/// Metres a unit, and its name.
struct Unit {
  double scale;
  const char* name;
};

/// The unit in which the smallest extent would be that of a passage.
Unit likelyUnit(double smallest_m) {
  if (smallest_m >= 1000.0) return {0.001, "millimetres"};
  if (smallest_m >= kHighestHall_m) return {0.01, "centimetres"};
  return {1000.0, "kilometres"};
}

AxisAlignedBox scaled(const AxisAlignedBox& box, double scale) {
  return {scale * box.min, scale * box.max};
}

std::string tryText(const std::string& option, const std::string& value, const std::string& key) {
  return "try --world-" + option + " " + value + " (world_" + option + ":=" + value +
         " in launch files, " + key + " in the <name>.json beside the mesh)";
}

std::string scaleAdvice(const AxisAlignedBox& bounds) {
  const double smallest = bounds.size().minCoeff();
  if (smallest > kLowestPassage_m && smallest < kHighestHall_m) return "";
  const Unit unit = likelyUnit(smallest);
  std::ostringstream scale;
  scale << unit.scale;
  return ": is it in " + std::string(unit.name) + "? Then it is " +
         sizeText(scaled(bounds, unit.scale)) + ": " +
         tryText("scale", scale.str(), "\"scale\": " + scale.str());
}

std::string upAdvice(const AxisAlignedBox& bounds) {
  const Eigen::Vector3d size = bounds.size();
  const double narrowest = std::min(size.x(), size.y());
  if (size.z() < kUprightRatio * narrowest) return "";
  const std::string axis = size.y() <= size.x() ? "y" : "x";
  return ": it is higher than wide; does " + axis + " point up in it? " +
         tryText("up", axis, "\"up\": \"" + axis + "\"");
}

}  // namespace

std::string sizeText(const AxisAlignedBox& bounds) {
  const Eigen::Vector3d size = bounds.size();
  std::ostringstream text;
  text.precision(3);
  for (int k = 0; k < 3; ++k) {
    if (k > 0) text << " x ";
    if (size(k) < 100.0)
      text << size(k);
    else
      text << std::llround(size(k));
  }
  return text.str() + " m";
}

std::string boundsText(const AxisAlignedBox& bounds) {
  return sizeText(bounds) + " from " + textOf(bounds.min) + " to " + textOf(bounds.max);
}

std::string sizeAdvice(const AxisAlignedBox& bounds) {
  return scaleAdvice(bounds) + upAdvice(bounds);
}

}  // namespace spelunk::sim
