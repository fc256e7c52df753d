#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/visualization/scene.h"

namespace spelunk::visualization {
namespace {

struct PlyContent {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Colour> colours;
  std::vector<std::pair<std::size_t, std::size_t>> edges;
};

Colour colourOf(const Element& element, std::size_t point) {
  return element.colours.size() == 1 ? element.colours.front() : element.colours[point];
}

void appendBox(const Element& element, PlyContent& ply) {
  const std::size_t first = ply.vertices.size();
  const double c = std::cos(element.yaw);
  const double s = std::sin(element.yaw);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) ? 0.5 : -0.5, (corner & 2) ? 0.5 : -0.5,
                               (corner & 4) ? 0.5 : -0.5);
    const Eigen::Vector3d local = sign.cwiseProduct(element.extents_m);
    const Eigen::Vector3d turned(c * local.x() - s * local.y(), s * local.x() + c * local.y(),
                                 local.z());
    ply.vertices.push_back(element.points.front() + turned);
    ply.colours.push_back(element.colours.front());
  }
  for (std::size_t corner = 0; corner < 8; ++corner)
    for (const std::size_t bit : std::array<std::size_t, 3>{1, 2, 4})
      if (!(corner & bit)) ply.edges.emplace_back(first + corner, first + (corner | bit));
}

void append(const Element& element, PlyContent& ply) {
  if (element.shape == Shape::kText) return;
  if (element.shape == Shape::kBox) return appendBox(element, ply);
  const std::size_t first = ply.vertices.size();
  for (std::size_t i = 0; i < element.points.size(); ++i) {
    ply.vertices.push_back(element.points[i]);
    ply.colours.push_back(colourOf(element, i));
  }
  const std::size_t stride = element.shape == Shape::kLineList ? 2 : 1;
  if (element.shape != Shape::kLineList && element.shape != Shape::kLineStrip) return;
  for (std::size_t i = 0; i + 1 < element.points.size(); i += stride)
    ply.edges.emplace_back(first + i, first + i + 1);
}

int byteOf(float share) { return static_cast<int>(std::lround(share * 255.0F)); }

}  // namespace

void savePly(const Scene& scene, const std::string& path) {
  PlyContent ply;
  for (const Element& element : scene.elements()) append(element, ply);
  std::ofstream file(path);
  file << "ply\nformat ascii 1.0\nelement vertex " << ply.vertices.size()
       << "\nproperty float x\nproperty float y\nproperty float z\n"
          "property uchar red\nproperty uchar green\nproperty uchar blue\nelement edge "
       << ply.edges.size() << "\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  for (std::size_t i = 0; i < ply.vertices.size(); ++i) {
    const Colour& colour = ply.colours[i];
    file << ply.vertices[i].x() << ' ' << ply.vertices[i].y() << ' ' << ply.vertices[i].z() << ' '
         << byteOf(colour.r) << ' ' << byteOf(colour.g) << ' ' << byteOf(colour.b) << '\n';
  }
  for (const auto& [from, to] : ply.edges) file << from << ' ' << to << '\n';
  file.close();
  if (!file)
    throw OutsideError("cannot write '" + path + "': check that the folder exists and is writable");
}

}  // namespace spelunk::visualization
