#include "ray_fan.h"

#include <algorithm>
#include <cmath>

namespace spelunk::terrain {
namespace {

constexpr int kSectors = 512;  // 5 cm apart at 4 m

/// Grows with the azimuth from 0 to 4, without trigonometry.
float diamondAngle(const Eigen::Vector2f& place) {
  const float share = place.x() / (std::fabs(place.x()) + std::fabs(place.y()));
  return place.y() >= 0.0F ? 1.0F - share : 3.0F + share;
}

}  // namespace

RayFan::RayFan(double ring_m, double reach_m)
    : rings_per_m_(static_cast<float>(1.0 / ring_m)),
      rings_(static_cast<int>(reach_m / ring_m) + 2),
      steepest_(static_cast<std::size_t>(kSectors) * rings_) {}

void RayFan::clear() { std::fill(steepest_.begin(), steepest_.end(), 0.0F); }

std::size_t RayFan::indexOf(const Eigen::Vector2f& place, float distance) const {
  const int sector = std::min(static_cast<int>(diamondAngle(place) * (kSectors / 4)), kSectors - 1);
  const float ring = std::min(distance * rings_per_m_, static_cast<float>(rings_ - 1));
  return static_cast<std::size_t>(sector * rings_ + static_cast<int>(ring));
}

void RayFan::add(const Eigen::Vector3f& end) {
  const float distance = end.head<2>().norm();
  if (!(end.z() < 0.0F) || !(distance > 0.0F)) return;
  float& steepest = steepest_[indexOf(end.head<2>(), distance)];
  steepest = std::max(steepest, -end.z() / distance);
}

void RayFan::finish() {
  for (std::size_t begin = 0; begin < steepest_.size(); begin += static_cast<std::size_t>(rings_)) {
    float steepest = 0.0F;
    for (std::size_t i = begin + static_cast<std::size_t>(rings_); i-- > begin;) {
      const float ends_here = steepest_[i];
      steepest_[i] = steepest;
      steepest = std::max(steepest, ends_here);
    }
  }
}

float RayFan::steepestBeyond(const Eigen::Vector2f& place) const {
  const float distance = place.norm();
  if (!(distance > 0.0F)) return 0.0F;
  return steepest_[indexOf(place, distance)];
}

}  // namespace spelunk::terrain
