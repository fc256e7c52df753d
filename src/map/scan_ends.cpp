#include "scan_ends.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/wide_loops.h"

namespace spelunk::map {
namespace {

constexpr std::size_t kBlock = 256;
constexpr PackedKey kNoKey = ~PackedKey{0};
constexpr double kFar = 1 << 30;  // voxels; beyond all keys

/// One coordinate of points in the world: a row of the transform.
struct Row {
  double x, y, z, shift;
};

Row rowOf(const Eigen::Isometry3d& T, int axis) {
  return {T.linear()(axis, 0), T.linear()(axis, 1), T.linear()(axis, 2), T.translation()(axis)};
}

/// `from` holds x, y and z of each point in turn.
SPELUNK_WIDE_IF_POSSIBLE void transform(const float* from, std::size_t count, Row row,
                                        double* __restrict to) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = row.x * static_cast<double>(from[3 * i]) +
            row.y * static_cast<double>(from[3 * i + 1]) +
            row.z * static_cast<double>(from[3 * i + 2]) + row.shift;
}

SPELUNK_WIDE_IF_POSSIBLE void squareNorms(const float* from, std::size_t count,
                                          double* __restrict to) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(from[3 * i]);
    const auto y = static_cast<double>(from[3 * i + 1]);
    const auto z = static_cast<double>(from[3 * i + 2]);
    to[i] = x * x + y * y + z * z;
  }
}

/// As voxelOf, for what has a key; any number for what has none.
SPELUNK_WIDE_IF_POSSIBLE void findVoxels(const double* coordinates, std::size_t count,
                                         double inverse_resolution, float* __restrict points,
                                         std::int32_t* __restrict voxels) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto rounded = static_cast<float>(coordinates[i]);
    points[i] = rounded;
    const double scaled = static_cast<double>(rounded) * inverse_resolution;
    const double bounded = std::min(kFar, std::max(-kFar, scaled));  // what is no number: -kFar
    const auto towards_zero = static_cast<std::int32_t>(bounded);
    voxels[i] = towards_zero - (bounded < static_cast<double>(towards_zero) ? 1 : 0);
  }
}

SPELUNK_WIDE_IF_POSSIBLE void findCentres(const std::int32_t* voxels, std::size_t count,
                                          double resolution_m, float* __restrict points) {
  for (std::size_t i = 0; i < count; ++i)
    points[i] = static_cast<float>((static_cast<double>(voxels[i]) + 0.5) * resolution_m);
}

/// What the points of a scan have in common.
struct Frame {
  Row rows[3];
  AxisAlignedBox body;
  double near_squared;
  double limit;  ///< Coordinates at or beyond it have no key.
  double inverse_resolution;
};

/// Some points of a scan.
struct Block {
  double world[3][kBlock];
  double squared[kBlock];  ///< Norm in the sensor's frame.
  float point[3][kBlock];  ///< In the world.
  std::int32_t voxel[3][kBlock];
  PackedKey key[kBlock];  ///< Of the voxel; kNoKey for points that are not usable.
};

/// Comparisons with what is not a number fail: it is not usable.
SPELUNK_WIDE_IF_POSSIBLE void findKeys(const Frame& frame, std::size_t count,
                                       Block& __restrict block) {
  const double near_squared = frame.near_squared;
  const double limit = frame.limit;
  const double x_min = frame.body.min.x(), x_max = frame.body.max.x();
  const double y_min = frame.body.min.y(), y_max = frame.body.max.y();
  const double z_min = frame.body.min.z(), z_max = frame.body.max.z();
  for (std::size_t i = 0; i < count; ++i) {
    const double x = block.world[0][i], y = block.world[1][i], z = block.world[2][i];
    const bool is_far_enough = (block.squared[i] >= near_squared) & (block.squared[i] > 0.0);
    const bool has_key = (std::fabs(x) < limit) & (std::fabs(y) < limit) & (std::fabs(z) < limit);
    const bool is_off_body =
        (x < x_min) | (x > x_max) | (y < y_min) | (y > y_max) | (z < z_min) | (z > z_max);
    const PackedKey key = packIndex(block.voxel[0][i], block.voxel[1][i], block.voxel[2][i]);
    block.key[i] = is_far_enough & has_key & is_off_body ? key : kNoKey;
  }
}

Frame frameOf(const Scan& scan, const AxisAlignedBox& body, double range_min_m,
              double resolution_m) {
  const Eigen::Isometry3d& T = scan.T_world_sensor;
  const double limit = keyLimit(resolution_m);
  const bool has_key = (T.translation().array().abs() < limit).all();  // else no ray has one
  return {{rowOf(T, 0), rowOf(T, 1), rowOf(T, 2)},
          body,
          range_min_m * range_min_m,
          has_key ? limit : 0.0,
          1.0 / resolution_m};
}

void fill(const Eigen::Vector3f* points, std::size_t count, const Frame& frame, Block& block) {
  const float* from = points->data();
  squareNorms(from, count, block.squared);
  for (int axis = 0; axis < 3; ++axis) {
    transform(from, count, frame.rows[axis], block.world[axis]);
    findVoxels(block.world[axis], count, frame.inverse_resolution, block.point[axis],
               block.voxel[axis]);
  }
  findKeys(frame, count, block);
}

void add(const Block& block, std::size_t i, ScanEnds& ends) {
  ends.set(ends.count++, {block.point[0][i], block.point[1][i], block.point[2][i]},
           {block.voxel[0][i], block.voxel[1][i], block.voxel[2][i]});
}

/// Of a point that is not usable.
void countDropped(const Block& block, std::size_t i, const Frame& frame, MapUpdate& update) {
  const Eigen::Vector3d in_world(block.world[0][i], block.world[1][i], block.world[2][i]);
  const double squared = block.squared[i];  // of floats: cannot overflow
  if (!std::isfinite(squared))
    ++update.dropped_not_finite;
  else if (squared < frame.near_squared || squared == 0.0)
    ++update.dropped_near;
  else if (frame.body.contains(in_world))
    ++update.dropped_self;
  else
    ++update.dropped_far;
}

}  // namespace

void ScanEnds::makeRoomFor(std::size_t ends) {
  if (point[0].size() >= ends) return;
  for (int axis = 0; axis < 3; ++axis) {
    point[axis].resize(ends);
    voxel[axis].resize(ends);
  }
}

void ScanEnds::set(std::size_t i, const Eigen::Vector3f& end, const VoxelIndex& around) {
  for (int axis = 0; axis < 3; ++axis) {
    point[axis][i] = end(axis);
    voxel[axis][i] = around(axis);
  }
}

Eigen::Vector3f ScanEnds::pointAt(std::size_t i) const {
  return {point[0][i], point[1][i], point[2][i]};
}

VoxelIndex ScanEnds::voxelAt(std::size_t i) const {
  return {voxel[0][i], voxel[1][i], voxel[2][i]};
}

ScanPoints::ScanPoints(const MapParams& params)
    : resolution_m_(params.resolution_m),
      range_min_m_(params.range_min_m),
      discretize_(params.discretize) {}

void ScanPoints::findEnds(const Scan& scan, const AxisAlignedBox& robot_body, ScanMarks& marks,
                          ScanEnds& ends, MapUpdate& update) const {
  const Frame frame = frameOf(scan, robot_body, range_min_m_, resolution_m_);
  ends.count = 0;
  ends.makeRoomFor(scan.points.size());
  PackedKey last = kNoKey;  // neighbours in a scan often share a voxel
  Block block;
  for (std::size_t first = 0; first < scan.points.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, scan.points.size() - first);
    fill(scan.points.data() + first, count, frame, block);
    for (std::size_t i = 0; i < count; ++i) {
      if (block.key[i] == kNoKey) {
        countDropped(block, i, frame, update);
      } else if (block.key[i] != last || !discretize_) {
        last = block.key[i];
        if (marks.markHit(last) || !discretize_) add(block, i, ends);
      }
    }
  }
  if (!discretize_) return;
  for (int axis = 0; axis < 3; ++axis)
    findCentres(ends.voxel[axis].data(), ends.count, resolution_m_, ends.point[axis].data());
}

}  // namespace spelunk::map
