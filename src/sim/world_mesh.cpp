#include "spelunk/sim/world_mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "exact_file.h"
#include "mesh_builder.h"
#include "sidecar.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"
#include "spelunk/sim/mesh_size.h"

namespace spelunk::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kCoarse_m = 2e-3;  ///< Steps that cost more than a millimetre are said.

/// p_mesh = linear * p_read + offset: from what the importer read into the frame of the mesh.
struct FromRead {
  Eigen::Matrix3d linear;
  Eigen::Vector3d offset;

  [[nodiscard]] Eigen::Vector3d operator()(const aiVector3D& v) const {
    return linear * Eigen::Vector3d(v.x, v.y, v.z) + offset;
  }
};

aiVector3D corner(const aiMesh& part, const aiFace& face, unsigned k, const aiMatrix4x4& T) {
  return T * part.mVertices[face.mIndices[k]];
}

/// Adds the triangles of a node and of everything below it.
void addNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_world_parent,
             const FromRead& from_read, MeshBuilder& builder) {
  const aiMatrix4x4 T_world_node = T_world_parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<Eigen::Vector3f, 3> corners;
      for (unsigned k = 0; k < 3; ++k) {
        corners[k] = from_read(corner(part, face, k, T_world_node)).cast<float>();
      }
      builder.addTriangle(corners);
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    addNode(scene, *node.mChildren[c], T_world_node, from_read, builder);
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

/// The first vertex of a node or of what lies below it.
std::optional<aiVector3D> firstVertexOf(const aiScene& scene, const aiNode& node,
                                        const aiMatrix4x4& T_world_parent) {
  const aiMatrix4x4 T_world_node = T_world_parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    if (part.mNumVertices == 0) continue;
    return T_world_node * part.mVertices[0];
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

/// The frame for a place in the world.
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
void sayIfCoarse(const std::string& path, const aiScene& scene, double scale) {
  float farthest = 0.0F;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned v = 0; v < scene.mMeshes[m]->mNumVertices; ++v) {
      const aiVector3D& at = scene.mMeshes[m]->mVertices[v];
      for (const float value : {at.x, at.y, at.z})
        if (std::isfinite(value)) farthest = std::max(farthest, std::fabs(value));
    }
  const float next = std::nextafter(farthest, std::numeric_limits<float>::infinity());
  sayIfCoarse(
      path, scale * (next - farthest),
      "32-bit numbers at a coordinate of " + std::to_string(std::lround(scale * farthest)) + " m");
}

/// Reads a file in which every vertex is moved by whole units of the file near to the origin of
/// `frame`: decimal text keeps its digits, and what is left of the way is gone in double precision.
void addExact(const ExactFile& exact, const std::string& path, const Eigen::Matrix3d& T_world_file,
              const LocalFrame& frame, MeshBuilder& builder) {
  const Eigen::Vector3d by = (T_world_file.inverse() * -frame.origin()).array().round();
  const std::string bytes = exact.movedBy(by);
  const std::string kind = fs::path(path).extension().string().substr(1);
  Assimp::Importer importer;
  const aiScene& scene = sceneOf(
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, kind.c_str()),
      importer, path);
  addNode(scene, *scene.mRootNode, {}, {T_world_file, -(T_world_file * by) - frame.origin()},
          builder);
}

/// Adds a file's triangles in a frame near the start. Decimal text and 64-bit numbers are moved
/// there before they become 32-bit numbers, others when it is too late.
void addFile(const std::string& path, const Eigen::Matrix3d& T_world_file,
             const Surroundings& around, WorldMesh& mesh, MeshBuilder& builder) {
  const double scale = std::cbrt(std::fabs(T_world_file.determinant()));
  const auto place = around.start ? around.start
                     : mesh.start ? std::optional<Eigen::Vector3d>(mesh.start->position)
                                  : std::nullopt;
  const bool is_near = place && frameAround(*place, around).isCallers();
  const auto exact = is_near ? std::nullopt : ExactFile::read(path);
  if (exact) {
    mesh.frame = frameAround(place.value_or(T_world_file * exact->firstVertex()), around);
    sayIfCoarse(path, scale * exact->coarsestStep(), "so few digits are written");
  }
  if (exact && !mesh.frame.isCallers())
    return addExact(*exact, path, T_world_file, mesh.frame, builder);
  Assimp::Importer importer;
  const aiScene& scene = sceneOf(importer.ReadFile(path, aiProcess_Triangulate), importer, path);
  if (!exact) sayIfCoarse(path, scene, scale);
  const aiMatrix4x4 T_read_file = fromImporterFrame(path);
  const FromRead in_world{T_world_file, Eigen::Vector3d::Zero()};
  const auto vertex = firstVertexOf(scene, *scene.mRootNode, T_read_file);
  if (place || vertex) mesh.frame = frameAround(place ? *place : in_world(*vertex), around);
  addNode(scene, *scene.mRootNode, T_read_file, {T_world_file, -mesh.frame.origin()}, builder);
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
  const AxisAlignedBox bounds = mesh.frame.toCaller(mesh.bounds());
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

WorldMesh loadWorldMesh(const std::string& path, const MeshFrame& told,
                        const Surroundings& around) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure))
    throw OutsideError(path + ": no such mesh file; give a .dae, .stl, .obj or .ply file");
  if (fs::file_size(path, failure) == 0) throw OutsideError(path + ": the mesh file is empty");
  WorldMesh mesh;
  mesh.name = fs::path(path).stem().string();
  const Sidecar sidecar = readSidecar(path);
  mesh.start = sidecar.start;
  MeshBuilder builder(mesh);
  addFile(path, told.elseOf(sidecar.frame).T_world_file(), around, mesh, builder);
  requireUsable(builder, mesh, path);
  describe(builder, mesh, path);
  if (mesh.start) mesh.start = mesh.frame.written(*mesh.start);
  if (sidecar.bounds) mesh.exploration_bounds = mesh.frame.toLocal(*sidecar.bounds);
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
