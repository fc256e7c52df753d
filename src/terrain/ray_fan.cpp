#include "ray_fan.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/wide_loops.h"

namespace spelunk::terrain {
namespace {

constexpr int kSectors = 512;  // 5 cm apart at 4 m
constexpr float kSectorsPerQuadrant = kSectors / 4;
constexpr int kGroupSectors = 8;
constexpr float kArc = 1.01F;  // the ends of an arc over a group of sectors, to lie outside of it

/// Of the ring and sector of a place: the sector by an angle that needs no trigonometry.
inline std::int32_t indexOf(float x, float y, float distance, float rings_per_m, int rings) {
  const float sum = std::max(std::fabs(x) + std::fabs(y), 1e-6F);
  const float turn = y >= 0.0F ? 1.0F - x / sum : 3.0F + x / sum;
  const int sector = std::min(static_cast<int>(turn * kSectorsPerQuadrant), kSectors - 1);
  const float last_ring = static_cast<float>(rings - 1);
  const int ring = static_cast<int>(std::min(distance * rings_per_m, last_ring));
  return ring * kSectors + sector;
}

/// Of unit length, where `sector` begins.
Eigen::Vector2f directionOf(int sector) {
  const float turn = static_cast<float>(sector) / kSectorsPerQuadrant;
  const float x = turn <= 2.0F ? 1.0F - turn : turn - 3.0F;
  const float y = turn <= 2.0F ? 1.0F - std::fabs(x) : std::fabs(x) - 1.0F;
  return Eigen::Vector2f(x, y).normalized();
}

/// Makes the rows' ranges hold whatever is within a step of the line from a to b.
void widen(const RayFan::Places& places, const Eigen::Vector2f& a, const Eigen::Vector2f& b,
           std::vector<RayFan::Range>& rows) {
  const Eigen::Vector2f from = (a - places.first) / places.step;
  const Eigen::Vector2f to = (b - places.first) / places.step;
  const auto last = static_cast<float>(places.side - 1);
  const float low = std::clamp(std::min(from.y(), to.y()) - 1.0F, 0.0F, last + 1.0F);
  const float high = std::clamp(std::max(from.y(), to.y()) + 1.0F, -1.0F, last);
  const float rise = to.y() - from.y();
  const float slope = std::fabs(rise) > 1e-3F ? (to.x() - from.x()) / rise : 0.0F;
  const auto [left, right] = std::minmax(from.x(), to.x());
  for (auto j = static_cast<int>(std::ceil(low)); j <= static_cast<int>(std::floor(high)); ++j) {
    const float middle = from.x() + (static_cast<float>(j) - from.y()) * slope;
    const float half = slope != 0.0F ? std::fabs(slope) : right - left;
    const float begin = std::clamp(std::max(left, middle - half) - 1.0F, 0.0F, last + 1.0F);
    const float end = std::clamp(std::min(right, middle + half) + 2.0F, 0.0F, last + 1.0F);
    RayFan::Range& row = rows[static_cast<std::size_t>(j)];
    row.begin = std::min(row.begin, static_cast<int>(begin));
    row.end = std::max(row.end, static_cast<int>(end));
  }
}

}  // namespace

RayFan::RayFan(double ring_m, double reach_m)
    : rings_per_m_(static_cast<float>(1.0 / ring_m)),
      rings_(static_cast<int>(reach_m / ring_m) + 2),
      steepest_(static_cast<std::size_t>(kSectors) * rings_),
      farthest_ring_{} {}

void RayFan::clear() {
  std::fill(steepest_.begin(), steepest_.end(), 0.0F);
  farthest_ring_.fill(0);
  batched_ = 0;
}

SPELUNK_WIDE_IF_POSSIBLE void RayFan::enterBatch() {
  std::array<std::int32_t, kBatch> index;
  std::array<float, kBatch> steepness;
  const Batch& batch = batch_;
  const float rings_per_m = rings_per_m_;
  const int rings = rings_;
  for (std::size_t i = 0; i < batched_; ++i) {
    const float x = batch.x[i], y = batch.y[i], z = batch.z[i];
    const float distance = std::sqrt(x * x + y * y);
    index[i] = indexOf(x, y, distance, rings_per_m, rings);
    steepness[i] = z < 0.0F && distance > 0.0F ? -z / distance : 0.0F;
  }
  for (std::size_t i = 0; i < batched_; ++i) {
    const auto sector = static_cast<std::size_t>(index[i] % kSectors);
    const int ring = steepness[i] > 0.0F ? index[i] / kSectors : 0;
    float& steepest = steepest_[static_cast<std::size_t>(index[i])];
    steepest = std::max(steepest, steepness[i]);
    int& farthest = farthest_ring_[sector / kGroupSectors];
    farthest = std::max(farthest, ring);
  }
  batched_ = 0;
}

SPELUNK_WIDE_IF_POSSIBLE void RayFan::finish() {
  enterBatch();
  std::array<float, kSectors> beyond{};
  for (int ring = rings_ - 1; ring >= 0; --ring) {
    float* here = steepest_.data() + static_cast<std::size_t>(ring) * kSectors;
    for (std::size_t sector = 0; sector < kSectors; ++sector) {
      const float ends_here = here[sector];
      here[sector] = beyond[sector];
      beyond[sector] = std::max(beyond[sector], ends_here);
    }
  }
}

std::vector<RayFan::Range> RayFan::reachOf(const Places& places) const {
  std::vector<Range> rows(static_cast<std::size_t>(places.side), Range{places.side, 0});
  const Eigen::Vector2f sensor = Eigen::Vector2f::Zero();
  for (int sector = 0; sector < kSectors; sector += kGroupSectors) {
    const int ring = farthest_ring_[static_cast<std::size_t>(sector / kGroupSectors)];
    if (ring == 0) continue;
    const float reach_m = kArc * static_cast<float>(ring) / rings_per_m_;
    const Eigen::Vector2f begin = reach_m * directionOf(sector);
    const Eigen::Vector2f end = reach_m * directionOf(sector + kGroupSectors);
    widen(places, sensor, begin, rows);
    widen(places, begin, end, rows);
    widen(places, end, sensor, rows);
  }
  return rows;
}

SPELUNK_WIDE_IF_POSSIBLE void RayFan::locate(const Places& places, float y, Range range,
                                             Row& row) const {
  float* const distances = row.distance.data();
  std::uint32_t* const index = row.index.data();
  const float rings_per_m = rings_per_m_;
  const int rings = rings_;
  const float x_first = places.first.x();
  const float step = places.step;
  for (int i = range.begin; i < range.end; ++i) {
    const float x = x_first + static_cast<float>(i) * step;
    const float distance = std::sqrt(x * x + y * y);
    distances[i] = distance;
    index[i] = static_cast<std::uint32_t>(indexOf(x, y, distance, rings_per_m, rings));
  }
}

}  // namespace spelunk::terrain
