#include "spelunk/sim/surface_nets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

/// Corner c of a cell lies at its bits (x: 1, y: 2, z: 4).
using CornerMask = unsigned;

bool hangsTogether(CornerMask corners) {
  if (corners == 0) return true;
  CornerMask reached = corners & (~corners + 1U);
  for (CornerMask before = 0; before != reached;) {
    before = reached;
    for (unsigned c = 0; c < 8; ++c) {
      if ((reached >> c & 1U) == 0) continue;
      for (const unsigned axis : {1U, 2U, 4U}) reached |= (1U << (c ^ axis)) & corners;
    }
  }
  return reached == corners;
}

std::array<bool, 256> simpleCells() {
  std::array<bool, 256> simple{};
  for (CornerMask mask = 0; mask < 256; ++mask)
    simple[mask] = hangsTogether(mask) && hangsTogether(~mask & 0xFFU);
  return simple;
}

struct Corners {
  std::array<std::size_t, 8> step{};
  explicit Corners(const ScalarGrid& grid) {
    for (unsigned c = 0; c < 8; ++c)
      step[c] = grid.offsetOf(static_cast<int>(c & 1U), static_cast<int>(c >> 1U & 1U),
                              static_cast<int>(c >> 2U));
  }
  [[nodiscard]] CornerMask freeOnes(const ScalarGrid& grid, std::size_t cell) const {
    CornerMask mask = 0;
    for (unsigned c = 0; c < 8; ++c)
      if (grid.values[cell + step[c]] < 0.0F) mask |= 1U << c;
    return mask;
  }
};

template <class Visit>
void forEachCell(const ScalarGrid& grid, Visit&& visit) {
  for (int z = 0; z + 1 < grid.size.z(); ++z)
    for (int y = 0; y + 1 < grid.size.y(); ++y)
      for (int x = 0; x + 1 < grid.size.x(); ++x) visit(x, y, z, grid.offsetOf(x, y, z));
}

/// The cell's vertex: the mean of the points where its edges cross the surface.
Eigen::Vector3d meanCrossing(const ScalarGrid& grid, const Corners& corners, std::size_t cell) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (unsigned c = 0; c < 8; ++c) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      if ((c >> axis & 1U) != 0) continue;
      const double low = grid.values[cell + corners.step[c]];
      const double high = grid.values[cell + corners.step[c | 1U << axis]];
      if ((low < 0.0) == (high < 0.0)) continue;
      Eigen::Vector3d crossing(c & 1U, c >> 1U & 1U, c >> 2U);
      crossing[axis] += low / (low - high);
      sum += crossing;
      ++count;
    }
  }
  return sum / count;
}

/// Appends the quad a-b-c-d as two triangles, cut along its shorter diagonal.
void addQuad(WorldMesh& mesh, int a, int b, int c, int d) {
  const auto gap = [&](int i, int j) {
    return (mesh.vertices[static_cast<std::size_t>(i)] - mesh.vertices[static_cast<std::size_t>(j)])
        .squaredNorm();
  };
  if (gap(a, c) <= gap(b, d)) {
    mesh.triangles.emplace_back(a, b, c);
    mesh.triangles.emplace_back(a, c, d);
  } else {
    mesh.triangles.emplace_back(b, c, d);
    mesh.triangles.emplace_back(b, d, a);
  }
}

}  // namespace

void makeManifold(ScalarGrid& grid) {
  const std::array<bool, 256> simple = simpleCells();
  const Corners corners(grid);
  const float freed = static_cast<float>(-0.05 * grid.cell_m);
  for (bool changed = true; changed;) {
    changed = false;
    forEachCell(grid, [&](int, int, int, std::size_t cell) {
      while (!simple[corners.freeOnes(grid, cell)]) {
        std::size_t weakest = cell;
        float least = std::numeric_limits<float>::infinity();
        for (const std::size_t step : corners.step) {
          const float value = grid.values[cell + step];
          if (value < 0.0F || value >= least) continue;
          least = value;
          weakest = cell + step;
        }
        grid.values[weakest] = freed;
        changed = true;
      }
    });
  }
}

void keepConnected(ScalarGrid& grid, const Eigen::Vector3d& seed) {
  const Eigen::Vector3d local = (seed - grid.origin) / grid.cell_m;
  const std::size_t first = grid.offsetOf(static_cast<int>(std::lround(local.x())),
                                          static_cast<int>(std::lround(local.y())),
                                          static_cast<int>(std::lround(local.z())));
  require(grid.values[first] < 0.0F, "keepConnected: the seed is not free");
  std::vector<std::uint8_t> reached(grid.values.size(), 0);
  std::vector<std::size_t> open{first};
  reached[first] = 1;
  const std::array<std::size_t, 3> steps{grid.offsetOf(1, 0, 0), grid.offsetOf(0, 1, 0),
                                         grid.offsetOf(0, 0, 1)};
  const auto enter = [&](std::size_t cell) {
    if (reached[cell] != 0 || grid.values[cell] >= 0.0F) return;
    reached[cell] = 1;
    open.push_back(cell);
  };
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    for (const std::size_t step : steps) {
      enter(cell + step);
      enter(cell - step);
    }
  }
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (reached[i] == 0 && grid.values[i] < 0.0F) grid.values[i] = static_cast<float>(grid.cell_m);
}

WorldMesh surfaceOf(const ScalarGrid& grid) {
  WorldMesh mesh;
  const Corners corners(grid);
  std::vector<int> vertex_of(grid.values.size(), -1);
  forEachCell(grid, [&](int x, int y, int z, std::size_t cell) {
    const CornerMask free = corners.freeOnes(grid, cell);
    if (free == 0 || free == 0xFFU) return;
    vertex_of[cell] = static_cast<int>(mesh.vertices.size());
    const Eigen::Vector3d p =
        grid.pointAt(x, y, z) + grid.cell_m * meanCrossing(grid, corners, cell);
    mesh.vertices.push_back(p.cast<float>());
  });
  const std::array<std::size_t, 3> step{corners.step[1], corners.step[2], corners.step[4]};
  forEachCell(grid, [&](int x, int y, int z, std::size_t cell) {
    const std::array<int, 3> at{x, y, z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      const bool low_free = grid.values[cell] < 0.0F;
      if (low_free == (grid.values[cell + step[axis]] < 0.0F) || at[u] == 0 || at[v] == 0) continue;
      const int a = vertex_of[cell - step[u] - step[v]];
      const int b = vertex_of[cell - step[v]];
      const int c = vertex_of[cell];
      const int d = vertex_of[cell - step[u]];
      if (low_free) {
        addQuad(mesh, d, c, b, a);
      } else {
        addQuad(mesh, a, b, c, d);
      }
    }
  });
  return mesh;
}

}  // namespace spelunk::sim
