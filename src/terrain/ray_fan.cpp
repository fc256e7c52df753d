#include "ray_fan.h"

#include <algorithm>
#include <cmath>

namespace spelunk::terrain {
namespace {

constexpr int kSectors = 512;  // 5 cm apart at 4 m

/// Of the ring and sector of a place: the sector by an angle that needs no trigonometry.
inline std::uint32_t indexOf(float x, float y, float distance, float rings_per_m, int rings) {
  const float sum = std::max(std::fabs(x) + std::fabs(y), 1e-6F);
  const float turn = y >= 0.0F ? 1.0F - x / sum : 3.0F + x / sum;
  const int sector = std::min(static_cast<int>(turn * (kSectors / 4)), kSectors - 1);
  const float last_ring = static_cast<float>(rings - 1);
  const int ring = static_cast<int>(std::min(distance * rings_per_m, last_ring));
  return static_cast<std::uint32_t>(ring * kSectors + sector);
}

}  // namespace

RayFan::RayFan(double ring_m, double reach_m)
    : rings_per_m_(static_cast<float>(1.0 / ring_m)),
      rings_(static_cast<int>(reach_m / ring_m) + 2),
      steepest_(static_cast<std::size_t>(kSectors) * rings_) {}

void RayFan::clear() { std::fill(steepest_.begin(), steepest_.end(), 0.0F); }

void RayFan::add(const Eigen::Vector3f& end) {
  const float distance = std::sqrt(end.x() * end.x() + end.y() * end.y());
  if (!(end.z() < 0.0F) || !(distance > 0.0F)) return;
  float& steepest = steepest_[indexOf(end.x(), end.y(), distance, rings_per_m_, rings_)];
  steepest = std::max(steepest, -end.z() / distance);
}

void RayFan::finish() {
  std::vector<float> beyond(kSectors, 0.0F);
  for (int ring = rings_ - 1; ring >= 0; --ring) {
    float* here = steepest_.data() + static_cast<std::size_t>(ring) * kSectors;
    for (std::size_t sector = 0; sector < kSectors; ++sector) {
      const float ends_here = here[sector];
      here[sector] = beyond[sector];
      beyond[sector] = std::max(beyond[sector], ends_here);
    }
  }
}

void RayFan::locate(float x_first, float x_step, float y, Row& row) const {
  float* distance = row.distance.data();
  std::uint32_t* index = row.index.data();
  const int count = static_cast<int>(row.index.size());
  for (int i = 0; i < count; ++i) {
    const float x = x_first + static_cast<float>(i) * x_step;
    distance[i] = std::sqrt(x * x + y * y);
    index[i] = indexOf(x, y, distance[i], rings_per_m_, rings_);
  }
}

}  // namespace spelunk::terrain
