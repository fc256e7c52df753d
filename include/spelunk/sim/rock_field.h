#pragma once

#include <Eigen/Core>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/sim/world_plan.h"

namespace spelunk::sim {

/// About the signed distance of a point to the rock's surface: negative in free space, positive in
/// rock; its zero set is the surface of the world.
class RockField {
 public:
  explicit RockField(const WorldPlan& plan);

  /// The spaces whose surface may lie in a region; others need not be asked there.
  struct Selection {
    std::vector<std::size_t> spaces;
    std::vector<std::size_t> blocks;
    std::vector<std::size_t> pits;
    [[nodiscard]] bool isEmpty() const { return spaces.empty(); }
  };
  [[nodiscard]] Selection select(const AxisAlignedBox& region) const;

  /// The value at a point of the region that `selection` was made for.
  [[nodiscard]] double at(const Eigen::Vector3d& point, const Selection& selection) const;
  [[nodiscard]] double at(const Eigen::Vector3d& point) const;

  /// Around all free space.
  [[nodiscard]] AxisAlignedBox bounds() const;

 private:
  enum class Shape { kSegment, kChamber, kHall };
  /// One primitive; those of one passage share a group and meet without blending.
  struct Space {
    Shape shape = Shape::kSegment;
    int group = 0;
    Station a;  ///< Segment: its ends. Chamber, hall: `a` holds floor and height.
    Station b;
    Eigen::Vector2d half = Eigen::Vector2d::Zero();  ///< Chamber's radii, hall's half size.
    AxisAlignedBox reach;                            ///< Around everything it may make free.
    double root_m = 0.8;                             ///< See Passage; the others have this.
  };
  /// Distance to walls and roof, and the height of the floor.
  struct Sample {
    double body = 0.0;
    double floor = 0.0;
  };
  void add(Space space);
  [[nodiscard]] static Sample sample(const Space& space, const Eigen::Vector3d& point);
  [[nodiscard]] static Sample sampleSegment(const Space& space, const Eigen::Vector3d& point);
  [[nodiscard]] static Sample sampleChamber(const Space& space, const Eigen::Vector3d& point);
  [[nodiscard]] static Sample sampleHall(const Space& space, const Eigen::Vector3d& point);
  [[nodiscard]] Sample blended(const Eigen::Vector3d& point, const Selection& selection) const;
  [[nodiscard]] double withFloorFeatures(double value, const Eigen::Vector3d& point,
                                         const Selection& selection) const;
  [[nodiscard]] double roughness(const Eigen::Vector3d& point, double above_floor) const;

  std::vector<Space> spaces_;
  std::vector<Pillar> pillars_;
  std::vector<Block> blocks_;
  std::vector<Pit> pits_;
  double deepest_pit_m_ = 0.0;
  double roughness_m_;
  double blend_m_;
  double grain_m_;
  double cell_m_;
  std::uint64_t seed_;
};

}  // namespace spelunk::sim
