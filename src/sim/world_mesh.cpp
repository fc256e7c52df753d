#include "spelunk/sim/world_mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_map>

#include "exact_file.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"

namespace spelunk::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kCoarse_m = 2e-3;  ///< Steps that cost more than a millimetre are said.

/// Collects triangles and gives vertices of equal coordinates one index, in order of appearance.
class Welder {
 public:
  explicit Welder(WorldMesh& mesh) : mesh_(mesh) {}

  void addTriangle(const std::array<Eigen::Vector3f, 3>& corners) {
    const Eigen::Vector3i triangle(indexOf(corners[0]), indexOf(corners[1]), indexOf(corners[2]));
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
      return;  // no area: nothing to hit
    mesh_.triangles.push_back(triangle);
  }

 private:
  using Bits = std::array<std::uint32_t, 3>;
  struct BitsHash {
    std::size_t operator()(const Bits& bits) const {
      std::uint64_t hash = 0xCBF29CE484222325ULL;
      for (const std::uint32_t part : bits) hash = (hash ^ part) * 0x9E3779B97F4A7C15ULL;
      return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
  };

  int indexOf(const Eigen::Vector3f& vertex) {
    const Eigen::Vector3f unsigned_zero = vertex + Eigen::Vector3f::Zero();  // -0 becomes +0
    Bits bits{};
    std::memcpy(bits.data(), unsigned_zero.data(), sizeof(bits));
    const auto [entry, is_new] = index_.try_emplace(bits, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(unsigned_zero);
    return entry->second;
  }

  WorldMesh& mesh_;
  std::unordered_map<Bits, int, BitsHash> index_;
};

aiVector3D corner(const aiMesh& part, const aiFace& face, unsigned k, const aiMatrix4x4& T) {
  return T * part.mVertices[face.mIndices[k]];
}

/// Adds the triangles of a node and of everything below it, all vertices moved by `by`.
void addNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_world_parent,
             const Eigen::Vector3d& by, Welder& welder) {
  const aiMatrix4x4 T_world_node = T_world_parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<Eigen::Vector3f, 3> corners;
      for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D v = corner(part, face, k, T_world_node);
        corners[k] = (Eigen::Vector3d(v.x, v.y, v.z) + by).cast<float>();
      }
      welder.addTriangle(corners);
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    addNode(scene, *node.mChildren[c], T_world_node, by, welder);
}

/// Assimp turns Collada files to y up, whatever their up-axis, and scales them to metres. Other
/// formats carry neither; they are metres with z up.
aiMatrix4x4 fromImporterFrame(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".dae") return {};
  return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
}

std::optional<Pose> readStart(const fs::path& mesh_path) {
  fs::path sidecar = mesh_path;
  sidecar.replace_extension(".json");
  std::ifstream stream(sidecar);
  if (!stream) return std::nullopt;
  const std::string remedy =
      sidecar.string() + ": must hold \"start\": [x, y, z, yaw] in metres and radians";
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  if (json.is_discarded() || !json.is_object())
    throw OutsideError(remedy + " (it is not a JSON object)");
  if (!json.contains("start")) return std::nullopt;
  const auto& start = json["start"];
  const auto is_number = [](const nlohmann::json& entry) { return entry.is_number(); };
  if (!start.is_array() || start.size() != 4 || !std::all_of(start.begin(), start.end(), is_number))
    throw OutsideError(remedy);
  return Pose{{start[0].get<double>(), start[1].get<double>(), start[2].get<double>()},
              start[3].get<double>()};
}

/// The first vertex of a node or of what lies below it.
std::optional<Eigen::Vector3d> firstVertexOf(const aiScene& scene, const aiNode& node,
                                             const aiMatrix4x4& T_world_parent) {
  const aiMatrix4x4 T_world_node = T_world_parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    if (part.mNumVertices == 0) continue;
    const aiVector3D v = T_world_node * part.mVertices[0];
    return Eigen::Vector3d(v.x, v.y, v.z);
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    if (const auto vertex = firstVertexOf(scene, *node.mChildren[c], T_world_node)) return vertex;
  return std::nullopt;
}

const aiScene& sceneOf(const aiScene* scene, const Assimp::Importer& importer,
                       const std::string& path) {
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw OutsideError(path + ": cannot be read as a mesh (" + importer.GetErrorString() +
                       "); give a .dae, .stl, .obj or .ply file");
  return *scene;
}

/// The frame for a place of the mesh file.
LocalFrame frameAround(const Eigen::Vector3d& place, const Surroundings& around) {
  if (!place.allFinite()) return {};  // said when the whole mesh is looked at
  return LocalFrame::around(place, around.reach_m, around.range_m);
}

void sayIfCoarse(const std::string& path, double step_m, const std::string& why) {
  if (step_m <= kCoarse_m) return;
  char text[64];
  std::snprintf(text, sizeof text, "%.3g", 0.5 * step_m);
  log(LogLevel::kWarn, path + ": its vertices are only exact to " + text + " m (" + why +
                           "): export it around a local origin, or as .obj or .ply with all "
                           "decimals");
}

/// Half of the distance between neighbouring 32-bit numbers at the farthest coordinate is lost.
void sayIfCoarse(const std::string& path, const aiScene& scene) {
  float farthest = 0.0F;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned v = 0; v < scene.mMeshes[m]->mNumVertices; ++v) {
      const aiVector3D& at = scene.mMeshes[m]->mVertices[v];
      for (const float value : {at.x, at.y, at.z})
        if (std::isfinite(value)) farthest = std::max(farthest, std::fabs(value));
    }
  const float next = std::nextafter(farthest, std::numeric_limits<float>::infinity());
  sayIfCoarse(path, next - farthest,
              "32-bit numbers at a coordinate of " + std::to_string(std::lround(farthest)) + " m");
}

/// Adds a file's triangles in a frame near the start. Decimal text and 64-bit numbers are moved
/// there before they become 32-bit numbers, others when it is too late.
void addFile(const std::string& path, const Surroundings& around, WorldMesh& mesh, Welder& welder) {
  const aiMatrix4x4 T_world_file = fromImporterFrame(path);
  Assimp::Importer importer;
  const auto place = around.start ? around.start
                     : mesh.start ? std::optional<Eigen::Vector3d>(mesh.start->position)
                                  : std::nullopt;
  const bool is_near = place && frameAround(*place, around).isCallers();
  const auto exact = is_near ? std::nullopt : ExactFile::read(path);
  if (exact) {
    mesh.frame = frameAround(place.value_or(exact->firstVertex()), around);
    sayIfCoarse(path, exact->coarsestStep(), "so few digits are written");
  }
  if (exact && !mesh.frame.isCallers()) {
    const std::string bytes = exact->movedBy(-mesh.frame.origin());
    const std::string kind = fs::path(path).extension().string().substr(1);
    const aiScene& scene = sceneOf(importer.ReadFileFromMemory(bytes.data(), bytes.size(),
                                                               aiProcess_Triangulate, kind.c_str()),
                                   importer, path);
    return addNode(scene, *scene.mRootNode, T_world_file, Eigen::Vector3d::Zero(), welder);
  }
  const aiScene& scene = sceneOf(importer.ReadFile(path, aiProcess_Triangulate), importer, path);
  if (!exact) sayIfCoarse(path, scene);
  const auto vertex = firstVertexOf(scene, *scene.mRootNode, T_world_file);
  if (place || vertex) mesh.frame = frameAround(place ? *place : *vertex, around);
  addNode(scene, *scene.mRootNode, T_world_file, -mesh.frame.origin(), welder);
}

void requireUsable(const WorldMesh& mesh, const std::string& path) {
  if (mesh.triangles.empty())
    throw OutsideError(path + ": holds no triangles; export the world's surface as triangles");
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    if (!vertex.allFinite())
      throw OutsideError(path + ": has a vertex that is not finite; repair or re-export the mesh");
}

}  // namespace

AxisAlignedBox WorldMesh::bounds() const {
  require(!vertices.empty(), "WorldMesh::bounds: no vertices");
  Eigen::Vector3f low = vertices.front();
  Eigen::Vector3f high = vertices.front();
  for (const Eigen::Vector3f& vertex : vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  return {low.cast<double>(), high.cast<double>()};
}

WorldMesh loadWorldMesh(const std::string& path, const Surroundings& around) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure))
    throw OutsideError(path + ": no such mesh file; give a .dae, .stl, .obj or .ply file");
  if (fs::file_size(path, failure) == 0) throw OutsideError(path + ": the mesh file is empty");
  WorldMesh mesh;
  mesh.name = fs::path(path).stem().string();
  mesh.start = readStart(path);
  Welder welder(mesh);
  addFile(path, around, mesh, welder);
  requireUsable(mesh, path);
  if (mesh.start) mesh.start = mesh.frame.written(*mesh.start);
  return mesh;
}

void saveStl(const WorldMesh& mesh, const std::string& path) {
  std::string bytes(80, ' ');  // the header, unused by the format
  const auto append = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[static_cast<std::size_t>(triangle[0])];
    const Eigen::Vector3f& b = mesh.vertices[static_cast<std::size_t>(triangle[1])];
    const Eigen::Vector3f& c = mesh.vertices[static_cast<std::size_t>(triangle[2])];
    const Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
    for (const Eigen::Vector3f* part : {&normal, &a, &b, &c})
      for (int k = 0; k < 3; ++k) append((*part)[k]);
    append(std::uint16_t{0});
  }
  std::ofstream stream(path, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream.flush()) throw OutsideError(path + ": cannot be written; choose a writable folder");
}

}  // namespace spelunk::sim
