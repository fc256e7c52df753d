#pragma once

#include <limits>
#include <vector>

#include "spelunk/common/rng.h"
#include "spelunk/graph/point_index.h"
#include "spelunk/map/frozen_map.h"
#include "spelunk/planners/informed/informed_params.h"
#include "spelunk/planners/informed/reachability_graph.h"
#include "spelunk/planners/informed/region_reasoner.h"
#include "spelunk/planners/shared/free_place.h"

namespace spelunk::planners::informed {

/// A frontier candidate.
struct FrontierSample {
  graph::VertexId vertex{};  ///< Whose frontier it is of.
  Eigen::Vector3d voxel = Eigen::Vector3d::Zero();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Where the robot would go for it.
};

/// Frontier voxels without a free place beside them, for one plan: the voxels right beside such a
/// one are not looked at again.
class BarrenVoxels {
 public:
  void add(const Eigen::Vector3d& voxel) { index_.add(voxel); }
  [[nodiscard]] bool cover(const Eigen::Vector3d& voxel) const;

 private:
  graph::PointIndex index_;
};

/// Draws a few frontier voxels of vertices (Akbari 2021, section VII): no two places nearer than
/// d_s to each other, each geometrically feasible. In a branch voxels whose clearance lies between
/// the average and the maximum are drawn several times as often.
/// Differs from paper: the robot's box at a frontier voxel would always reach into the unknown,
/// which is never flown through, so the robot goes to the nearest place beside it where the box is
/// in known free space.
class FrontierSampler {
 public:
  static constexpr int kAll = std::numeric_limits<int>::max();

  /// A view for the duration of one plan. No sample is nearer than d_s to any of `apart_from`.
  FrontierSampler(const map::FrozenMap& map, const KnownSpace& space, const InformedParams& params,
                  Rng rng, BarrenVoxels& barren, std::vector<Eigen::Vector3d> apart_from = {});

  /// At most `count` samples of a vertex, in a branch one whose clearances are measured; places of
  /// earlier draws count for the distance d_s. With kAll all voxels are looked at but those right
  /// beside barren ones.
  [[nodiscard]] std::vector<FrontierSample> draw(graph::VertexId vertex, const VertexLabel& label,
                                                 int count, Region region);

  [[nodiscard]] int tried() const { return tried_; }
  [[nodiscard]] int infeasible() const { return infeasible_; }

 private:
  [[nodiscard]] std::vector<std::size_t> order(const VertexLabel& label, Region region);
  [[nodiscard]] bool isApart(const Eigen::Vector3d& place) const;

  const map::FrozenMap& map_;
  const KnownSpace& space_;
  const InformedParams& params_;
  PlaceFinder places_;
  Rng rng_;
  BarrenVoxels& barren_;
  std::vector<Eigen::Vector3d> chosen_;
  int tried_ = 0;
  int infeasible_ = 0;
};

}  // namespace spelunk::planners::informed
