#include "spelunk/sim/world_mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <fstream>

#include "mesh_builder.h"
#include "sidecar.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"
#include "spelunk/sim/mesh_size.h"

namespace spelunk::sim {
namespace {

namespace fs = std::filesystem;

aiVector3D corner(const aiMesh& part, const aiFace& face, unsigned k, const aiMatrix4x4& T) {
  return T * part.mVertices[face.mIndices[k]];
}

/// Adds the triangles of a node and of everything below it.
void addNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_world_parent,
             const Eigen::Matrix3d& T_world_file, MeshBuilder& builder) {
  const aiMatrix4x4 T_world_node = T_world_parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<Eigen::Vector3f, 3> corners;
      for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D v = corner(part, face, k, T_world_node);
        corners[k] = (T_world_file * Eigen::Vector3d(v.x, v.y, v.z)).cast<float>();
      }
      builder.addTriangle(corners);
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    addNode(scene, *node.mChildren[c], T_world_node, T_world_file, builder);
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

void requireUsable(const MeshBuilder& builder, const WorldMesh& mesh, const std::string& path) {
  if (builder.broken() > 0)
    throw OutsideError(path + ": " + std::to_string(builder.broken()) +
                       " triangles have a vertex that is not finite; repair or re-export the mesh");
  if (mesh.triangles.empty())
    throw OutsideError(path + ": holds no triangles" + (builder.flat() > 0 ? " with an area" : "") +
                       "; export the world's surface as triangles");
}

/// What was read and what was left out or looks odd.
void describe(const MeshBuilder& builder, const WorldMesh& mesh, const std::string& path) {
  const AxisAlignedBox bounds = mesh.bounds();
  log(LogLevel::kInfo,
      path + ": " + std::to_string(mesh.triangles.size()) + " triangles, " + boundsText(bounds));
  if (builder.flat() > 0 || builder.repeated() > 0)
    log(LogLevel::kWarn, path + ": left out " + std::to_string(builder.flat()) +
                             " triangles without area and " + std::to_string(builder.repeated()) +
                             " that are there twice");
  if (const std::string advice = sizeAdvice(bounds); !advice.empty())
    log(LogLevel::kWarn, path + ": " + sizeText(bounds) + advice);
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

WorldMesh loadWorldMesh(const std::string& path, const MeshFrame& told) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure))
    throw OutsideError(path + ": no such mesh file; give a .dae, .stl, .obj or .ply file");
  if (fs::file_size(path, failure) == 0) throw OutsideError(path + ": the mesh file is empty");
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw OutsideError(path + ": cannot be read as a mesh (" + importer.GetErrorString() +
                       "); give a .dae, .stl, .obj or .ply file");
  WorldMesh mesh;
  mesh.name = fs::path(path).stem().string();
  const Sidecar sidecar = readSidecar(path);
  MeshBuilder builder(mesh);
  addNode(*scene, *scene->mRootNode, fromImporterFrame(path),
          told.elseOf(sidecar.frame).T_world_file(), builder);
  requireUsable(builder, mesh, path);
  describe(builder, mesh, path);
  mesh.start = sidecar.start;
  mesh.exploration_bounds = sidecar.bounds;
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
