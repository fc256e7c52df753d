#include "sidecar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"

namespace spelunk::sim {
namespace {

using Json = nlohmann::json;

constexpr const char* kStart = "must hold \"start\": [x, y, z, yaw] in metres and radians";
constexpr const char* kScale =
    "must hold \"scale\": metres a unit of the mesh, 0.001 for millimetres";
constexpr const char* kUp =
    "must hold \"up\": \"x\", \"y\" or \"z\", the mesh's axis that points up";
constexpr const char* kBounds =
    "must hold \"bounds\": [[x, y, z], [x, y, z]], the lowest and the highest corner of what is to "
    "be explored, in metres, or the same six numbers in one list";

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  throw OutsideError(path.string() + ": " + reason);
}

/// The whole file; a fault is named with its line, its column and what stands there.
Json parsed(std::istream& stream, const std::filesystem::path& path) {
  try {
    return Json::parse(stream);
  } catch (const Json::exception& error) {  // a syntax error, or a number beyond all doubles
    const std::string text = error.what();  // "[json.exception.parse_error.101] parse error at ..."
    refuse(path, "is not valid JSON: " + text.substr(std::min(text.size(), text.find("] ") + 2)) +
                     "; correct it there (a comma too many or missing, a quote left out). " +
                     kStart);
  }
}

/// Finite numbers; none if there are more, fewer or anything else.
template <std::size_t kCount>
std::optional<std::array<double, kCount>> numbersOf(const Json& json) {
  if (!json.is_array() || json.size() != kCount) return std::nullopt;
  std::array<double, kCount> values{};
  for (std::size_t k = 0; k < kCount; ++k) {
    if (!json[k].is_number() || !std::isfinite(json[k].get<double>())) return std::nullopt;
    values[k] = json[k].get<double>();
  }
  return values;
}

Pose startOf(const Json& json, const std::filesystem::path& path) {
  const auto values = numbersOf<4>(json);
  if (!values) refuse(path, kStart);
  return {{(*values)[0], (*values)[1], (*values)[2]}, (*values)[3]};
}

double scaleOf(const Json& json, const std::filesystem::path& path) {
  if (!json.is_number() || !std::isfinite(json.get<double>()) || json.get<double>() <= 0.0)
    refuse(path, kScale);
  return json.get<double>();
}

UpAxis upOf(const Json& json, const std::filesystem::path& path) {
  const auto up = json.is_string() ? upAxisOf(json.get<std::string>()) : std::nullopt;
  if (!up) refuse(path, kUp);
  return *up;
}

AxisAlignedBox boundsOf(const Json& json, const std::filesystem::path& path) {
  Json numbers = json;
  if (json.is_array() && json.size() == 2 && json[0].is_array() && json[1].is_array()) {
    numbers = json[0];
    numbers.insert(numbers.end(), json[1].begin(), json[1].end());
  }
  const auto corners = numbersOf<6>(numbers);
  if (!corners) refuse(path, kBounds);
  const auto& c = *corners;
  const AxisAlignedBox box{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
  if ((box.min.array() >= box.max.array()).any()) refuse(path, kBounds);
  return box;
}

}  // namespace

Sidecar readSidecar(const std::filesystem::path& mesh_path) {
  std::filesystem::path path = mesh_path;
  path.replace_extension(".json");
  Sidecar sidecar;
  std::ifstream stream(path);
  if (!stream) return sidecar;
  const Json json = parsed(stream, path);
  if (!json.is_object()) refuse(path, std::string(kStart) + " (it is not a JSON object)");
  for (const auto& [key, value] : json.items()) {
    if (key == "start")
      sidecar.start = startOf(value, path);
    else if (key == "scale")
      sidecar.frame.scale = scaleOf(value, path);
    else if (key == "up")
      sidecar.frame.up = upOf(value, path);
    else if (key == "bounds")
      sidecar.bounds = boundsOf(value, path);
    else if (key != "artifacts")
      log(LogLevel::kWarn, path.string() + ": \"" + key +
                               "\" is not known and not used; start, scale, up, bounds and "
                               "artifacts are");
  }
  return sidecar;
}

}  // namespace spelunk::sim
