#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "spelunk/graph/point_index.h"

namespace spelunk::graph {

enum class VertexId : std::uint32_t {};

[[nodiscard]] inline std::size_t indexOf(VertexId id) { return static_cast<std::size_t>(id); }

struct Neighbour {
  VertexId id{};
  double weight = 0.0;
};

/// Undirected weighted graph whose vertices have positions (world frame, metres). Vertices are
/// numbered from 0 in the order they were added and are never removed; edges can be.
class SpatialGraph {
 public:
  VertexId addVertex(const Eigen::Vector3d& position);

  /// Adds an edge; one that exists already takes the new weight. Throws Precondition for a loop, a
  /// vertex that does not exist or a weight that is negative or not finite.
  void addEdge(VertexId a, VertexId b, double weight);
  void removeEdge(VertexId a, VertexId b);  ///< Nothing happens if there is none.
  [[nodiscard]] bool hasEdge(VertexId a, VertexId b) const;

  [[nodiscard]] std::size_t vertexCount() const { return neighbours_.size(); }
  [[nodiscard]] std::size_t edgeCount() const { return edge_count_; }
  [[nodiscard]] const Eigen::Vector3d& position(VertexId id) const {
    return index_.point(indexOf(id));
  }
  [[nodiscard]] const std::vector<Neighbour>& neighbours(VertexId id) const {
    return neighbours_[indexOf(id)];
  }
  /// Every edge once, the smaller vertex first, ordered by it.
  [[nodiscard]] std::vector<std::pair<VertexId, VertexId>> edges() const;

  [[nodiscard]] std::optional<VertexId> findNearest(const Eigen::Vector3d& point) const;
  /// Nearest first.
  [[nodiscard]] std::vector<VertexId> findWithin(const Eigen::Vector3d& point,
                                                 double radius_m) const;

 private:
  void requireVertex(VertexId id) const;

  PointIndex index_;
  std::vector<std::vector<Neighbour>> neighbours_;
  std::size_t edge_count_ = 0;
};

}  // namespace spelunk::graph
