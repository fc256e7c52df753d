#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/common/file_lookup.h"
#include "spelunk/sim/world_generator.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kCacheMagic = 0x314B5053;  // "SPK1"

std::uint64_t hashOf(const std::string& bytes) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;  // FNV-1a
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return hash;
}

std::string readFile(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw OutsideError(path.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// One file a description and generator: another text or version gives another name.
fs::path cachePath(const fs::path& description, const std::string& cache_dir) {
  std::ostringstream name;
  name << description.stem().string() << "-" << kWorldGeneratorVersion << "-" << std::hex
       << hashOf(readFile(description)) << ".mesh";
  return fs::path(cache_dir) / name.str();
}

template <class T>
void append(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// Takes `count` values off the front of `bytes`; false if there are too few.
template <class T>
bool take(std::string_view& bytes, T* values, std::size_t count) {
  if (bytes.size() / sizeof(T) < count) return false;
  if (count > 0) std::memcpy(values, bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
  return true;
}

std::string serialised(const WorldMesh& mesh) {
  std::string bytes;
  const std::array<std::uint32_t, 4> header{
      kCacheMagic, static_cast<std::uint32_t>(mesh.vertices.size()),
      static_cast<std::uint32_t>(mesh.triangles.size()), mesh.start ? 1U : 0U};
  append(bytes, header.data(), header.size());
  const Pose start = mesh.start.value_or(Pose{});
  append(bytes, start.position.data(), 3);
  append(bytes, &start.yaw, 1);
  for (const Eigen::Vector3f& vertex : mesh.vertices) append(bytes, vertex.data(), 3);
  for (const Eigen::Vector3i& triangle : mesh.triangles) append(bytes, triangle.data(), 3);
  const std::uint64_t checksum = hashOf(bytes);
  append(bytes, &checksum, 1);
  return bytes;
}

/// Nothing if the file is missing, cut short or damaged.
std::optional<WorldMesh> readCache(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return std::nullopt;
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::uint64_t checksum = 0;
  if (bytes.size() < sizeof(checksum)) return std::nullopt;
  const std::string content = bytes.substr(0, bytes.size() - sizeof(checksum));
  std::memcpy(&checksum, bytes.data() + content.size(), sizeof(checksum));
  std::array<std::uint32_t, 4> header{};
  std::string_view rest = content;
  if (checksum != hashOf(content) || !take(rest, header.data(), 4) || header[0] != kCacheMagic)
    return std::nullopt;
  WorldMesh mesh;
  Pose start;
  if (!take(rest, start.position.data(), 3) || !take(rest, &start.yaw, 1)) return std::nullopt;
  if (header[3] != 0) mesh.start = start;
  mesh.vertices.resize(header[1]);
  mesh.triangles.resize(header[2]);
  for (Eigen::Vector3f& vertex : mesh.vertices)
    if (!take(rest, vertex.data(), 3)) return std::nullopt;
  for (Eigen::Vector3i& triangle : mesh.triangles)
    if (!take(rest, triangle.data(), 3)) return std::nullopt;
  return mesh;
}

/// Best effort: the mesh is at hand whether or not it can be kept. Written under another name and
/// moved, so that a second process never reads half a file.
void writeCache(const WorldMesh& mesh, const fs::path& path) {
  std::error_code failure;
  fs::create_directories(path.parent_path(), failure);
  fs::path partial = path;
  partial += "." + std::to_string(getpid()) + ".part";
  std::ofstream stream(partial, std::ios::binary);
  const std::string bytes = serialised(mesh);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (stream) fs::rename(partial, path, failure);
  if (!stream || failure) fs::remove(partial, failure);
}

std::string knownNames(const std::string& worlds_dir) {
  std::vector<std::string> names;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(worlds_dir, failure))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

/// A mesh in the caller's frame, held in another one.
WorldMesh heldIn(const LocalFrame& frame, WorldMesh mesh) {
  if (frame.isCallers()) return mesh;
  mesh.frame = frame;
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = frame.toLocal<Eigen::Vector3d>(vertex.cast<double>()).cast<float>();
  if (mesh.start) mesh.start = frame.toLocal(*mesh.start);
  return mesh;
}

}  // namespace

std::string defaultCacheDir() {
  const auto valueOf = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  if (const std::string given = valueOf("SPELUNK_CACHE"); !given.empty()) return given;
  const std::string cache = valueOf("XDG_CACHE_HOME");
  const std::string home = valueOf("HOME");
  const fs::path base = !cache.empty()  ? fs::path(cache)
                        : !home.empty() ? fs::path(home) / ".cache"
                                        : fs::temp_directory_path();
  return (base / "spelunk").string();
}

WorldMesh openWorld(const std::string& name_or_path, const std::string& worlds_dir,
                    const std::string& cache_dir, const MeshFrame& told,
                    const Surroundings& around) {
  std::error_code failure;
  const fs::path description = fs::path(worlds_dir) / (name_or_path + ".yaml");
  if (looksLikePath(name_or_path))
    return loadWorldMesh(existingFile("mesh", name_or_path, {""}), told, around);
  if (!fs::is_regular_file(description, failure))
    throw OutsideError("world '" + name_or_path +
                       "' is not known; give the path of a mesh or one of: " +
                       knownNames(worlds_dir) + " (from " + worlds_dir + ")");
  if (!told.isSilent())
    throw OutsideError("world '" + name_or_path +
                       "' is generated in metres with z up: scale and up are for mesh files only");
  const fs::path cached = cachePath(description, cache_dir);
  std::optional<WorldMesh> mesh = readCache(cached);
  if (!mesh) {
    mesh = generateWorld(description.string());
    writeCache(*mesh, cached);
  }
  mesh->name = name_or_path;
  const Eigen::Vector3d first = around.start.value_or(mesh->start.value_or(Pose{}).position);
  return heldIn(LocalFrame::around(first, around.reach_m, around.range_m), std::move(*mesh));
}

}  // namespace spelunk::sim
