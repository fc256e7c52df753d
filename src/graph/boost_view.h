#pragma once

#include <boost/graph/graph_traits.hpp>
#include <boost/iterator/counting_iterator.hpp>
#include <boost/iterator/iterator_facade.hpp>
#include <boost/property_map/property_map.hpp>
#include <cstddef>
#include <utility>

#include "spelunk/graph/spatial_graph.h"

namespace spelunk::graph {

/// A SpatialGraph as Boost.Graph's algorithms read it (incidence and vertex list), without a copy.
/// The graph must outlive the view. Each edge is one from either of its ends.
struct BoostView {
  struct Edge {
    std::size_t from = 0;
    const Neighbour* to = nullptr;
    bool operator==(const Edge& other) const { return to == other.to; }
    bool operator!=(const Edge& other) const { return to != other.to; }
  };

  /// Over the edges from a vertex.
  class EdgeIterator
      : public boost::iterator_facade<EdgeIterator, Edge, boost::forward_traversal_tag, Edge> {
   public:
    EdgeIterator() = default;
    EdgeIterator(std::size_t from, const Neighbour* to) : edge_{from, to} {}

   private:
    friend class boost::iterator_core_access;
    [[nodiscard]] Edge dereference() const { return edge_; }
    [[nodiscard]] bool equal(const EdgeIterator& other) const { return edge_ == other.edge_; }
    void increment() { ++edge_.to; }

    Edge edge_;
  };

  struct Weights {
    using key_type = Edge;
    using value_type = double;
    using reference = double;
    using category = boost::readable_property_map_tag;
  };

  explicit BoostView(const SpatialGraph& spatial) : graph(&spatial) {}

  const SpatialGraph* graph;
};

inline double get(const BoostView::Weights& /*weights*/, const BoostView::Edge& edge) {
  return edge.to->weight;
}
inline std::size_t source(const BoostView::Edge& edge, const BoostView& /*view*/) {
  return edge.from;
}
inline std::size_t target(const BoostView::Edge& edge, const BoostView& /*view*/) {
  return indexOf(edge.to->id);
}
inline std::size_t num_vertices(const BoostView& view) { return view.graph->vertexCount(); }

inline auto vertices(const BoostView& view) {
  return std::pair(boost::counting_iterator<std::size_t>(0),
                   boost::counting_iterator<std::size_t>(view.graph->vertexCount()));
}

inline const std::vector<Neighbour>& neighboursOf(std::size_t vertex, const BoostView& view) {
  return view.graph->neighbours(VertexId{static_cast<std::uint32_t>(vertex)});
}

inline std::size_t out_degree(std::size_t vertex, const BoostView& view) {
  return neighboursOf(vertex, view).size();
}

inline auto out_edges(std::size_t vertex, const BoostView& view) {
  const std::vector<Neighbour>& to = neighboursOf(vertex, view);
  return std::pair(BoostView::EdgeIterator(vertex, to.data()),
                   BoostView::EdgeIterator(vertex, to.data() + to.size()));
}

}  // namespace spelunk::graph

namespace boost {

template <>
struct graph_traits<spelunk::graph::BoostView> {
  struct traversal_category : incidence_graph_tag, vertex_list_graph_tag {};
  using vertex_descriptor = std::size_t;
  using edge_descriptor = spelunk::graph::BoostView::Edge;
  using directed_category = directed_tag;
  using edge_parallel_category = disallow_parallel_edge_tag;
  using out_edge_iterator = spelunk::graph::BoostView::EdgeIterator;
  using vertex_iterator = counting_iterator<std::size_t>;
  using degree_size_type = std::size_t;
  using vertices_size_type = std::size_t;
  static vertex_descriptor null_vertex() { return static_cast<std::size_t>(-1); }
};

}  // namespace boost
