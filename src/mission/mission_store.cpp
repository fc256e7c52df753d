#include "spelunk/mission/mission_store.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "spelunk/common/contract.h"

namespace spelunk::mission {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;

enum class ZoneOrigin { kGiven, kMarked };

/// JSON knows no infinity: null stands for "no limit".
Json limitOf(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double limitFrom(const Json& json, double none) {
  return json.is_null() ? none : json.get<double>();
}

Json vectorOf(const Eigen::Vector3d& v) {
  return Json::array({limitOf(v.x()), limitOf(v.y()), limitOf(v.z())});
}

Eigen::Vector3d vectorFrom(const Json& json, double none) {
  return {limitFrom(json.at(0), none), limitFrom(json.at(1), none), limitFrom(json.at(2), none)};
}

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

Json jsonOf(const NoGoZone& zone, ZoneOrigin origin) {
  Json corners = Json::array();
  for (const Eigen::Vector2d& corner : zone.polygon)
    corners.push_back(Json::array({corner.x(), corner.y()}));
  return {{"name", zone.name},
          {"polygon", corners},
          {"z_min", limitOf(zone.z_min)},
          {"z_max", limitOf(zone.z_max)},
          {"marked_by_robot", origin == ZoneOrigin::kMarked}};
}

NoGoZone zoneFrom(const Json& json) {
  NoGoZone zone;
  zone.name = json.at("name").get<std::string>();
  for (const Json& corner : json.at("polygon"))
    zone.polygon.emplace_back(corner.at(0).get<double>(), corner.at(1).get<double>());
  zone.z_min = limitFrom(json.at("z_min"), -kNoLimit);
  zone.z_max = limitFrom(json.at("z_max"), kNoLimit);
  return zone;
}

/// Files of earlier versions do not tell the zones apart: people's.
ZoneOrigin originFrom(const Json& json) {
  return json.value("marked_by_robot", false) ? ZoneOrigin::kMarked : ZoneOrigin::kGiven;
}

Json layerOf(const planners::GraphLayer& layer) {
  Json vertices = Json::array();
  for (const planners::GraphVertex& vertex : layer.vertices)
    vertices.push_back(Json::array({vertex.position.x(), vertex.position.y(), vertex.position.z(),
                                    vertex.gain_m3, vertex.is_frontier}));
  Json edges = Json::array();
  for (const auto& [a, b] : layer.edges) edges.push_back(Json::array({a, b}));
  return {{"name", layer.name}, {"vertices", vertices}, {"edges", edges}};
}

planners::GraphLayer layerFrom(const Json& json) {
  planners::GraphLayer layer;
  layer.name = json.at("name").get<std::string>();
  for (const Json& vertex : json.at("vertices"))
    layer.vertices.push_back(
        {vectorFrom(vertex, 0.0), vertex.at(3).get<double>(), vertex.at(4).get<bool>()});
  for (const Json& edge : json.at("edges")) {
    layer.edges.emplace_back(edge.at(0).get<std::uint32_t>(), edge.at(1).get<std::uint32_t>());
    if (std::max(layer.edges.back().first, layer.edges.back().second) >= layer.vertices.size())
      throw OutsideError("graph layer '" + layer.name +
                         "' has an edge to a vertex it does not have");
  }
  return layer;
}

MissionRecord moved(MissionRecord record, const Shift& shift) {
  using spelunk::moved;
  record.bounds = moved(record.bounds, shift);
  record.given_zones = moved(std::move(record.given_zones), shift);
  record.marked_zones = moved(std::move(record.marked_zones), shift);
  record.trail = moved(std::move(record.trail), shift);
  record.graph = moved(std::move(record.graph), shift);
  return record;
}

/// A record whose places are in the caller's frame.
Json jsonOf(const MissionRecord& record) {
  Json json{{"format", kFormat}, {"remaining_s", record.remaining_s}};
  if (!record.frame.isCallers()) json["map_origin_m"] = vectorOf(record.frame.origin());
  if (record.frame.yaw() != 0.0) {
    json["map_yaw_rad"] = record.frame.yaw();
    json["map_turned_about_m"] = vectorOf(record.frame.T_caller_local().about);
  }
  json["bounds"] = {{"min", vectorOf(record.bounds.min)}, {"max", vectorOf(record.bounds.max)}};
  json["zones"] = Json::array();
  for (const NoGoZone& zone : record.given_zones)
    json["zones"].push_back(jsonOf(zone, ZoneOrigin::kGiven));
  for (const NoGoZone& zone : record.marked_zones)
    json["zones"].push_back(jsonOf(zone, ZoneOrigin::kMarked));
  json["trail"] = Json::array();
  for (const Pose& pose : record.trail)
    json["trail"].push_back(
        Json::array({pose.position.x(), pose.position.y(), pose.position.z(), pose.yaw}));
  json["graph"] = Json::array();
  for (const planners::GraphLayer& layer : record.graph.layers)
    json["graph"].push_back(layerOf(layer));
  return json;
}

Shift frameFrom(const Json& json) {
  Shift T_caller_map(vectorFrom(json.at("map_origin_m"), 0.0));
  if (!json.contains("map_yaw_rad")) return T_caller_map;
  T_caller_map.yaw_rad = json.at("map_yaw_rad").get<double>();
  T_caller_map.about = vectorFrom(json.at("map_turned_about_m"), 0.0);
  return T_caller_map;
}

MissionRecord recordFrom(const Json& json) {
  if (json.at("format").get<int>() != kFormat) throw OutsideError("it has an unknown format");
  MissionRecord record;
  record.remaining_s = json.at("remaining_s").get<double>();
  if (json.contains("map_origin_m")) record.frame = LocalFrame(frameFrom(json));
  record.bounds.min = vectorFrom(json.at("bounds").at("min"), -kNoLimit);
  record.bounds.max = vectorFrom(json.at("bounds").at("max"), kNoLimit);
  for (const Json& zone : json.at("zones"))
    (originFrom(zone) == ZoneOrigin::kMarked ? record.marked_zones : record.given_zones)
        .push_back(zoneFrom(zone));
  for (const Json& pose : json.at("trail"))
    record.trail.push_back({vectorFrom(pose, 0.0), pose.at(3).get<double>()});
  for (const Json& layer : json.at("graph")) record.graph.layers.push_back(layerFrom(layer));
  const Shift T_map_caller = record.frame.T_caller_local().inverse();
  return moved(std::move(record), T_map_caller);
}

}  // namespace

void writeRecord(const std::string& folder, const MissionRecord& record) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::string path = folder + "/mission.json";
  const std::string temporary = path + ".tmp";
  std::ofstream file(temporary);
  file << jsonOf(moved(record, record.frame.T_caller_local())).dump() << '\n';
  file.close();
  if (!file)
    throw OutsideError("cannot write '" + path + "': check the folder, its rights and space");
  std::filesystem::rename(temporary, path, error);
  if (error) throw OutsideError("cannot write '" + path + "': " + error.message());
}

MissionRecord readRecord(const std::string& folder) {
  const std::string path = folder + "/mission.json";
  std::ifstream file(path);
  if (!file) throw OutsideError("cannot read '" + path + "': is it a folder that save wrote?");
  try {
    return recordFrom(Json::parse(file));
  } catch (const Json::exception& error) {
    throw OutsideError("'" + path + "' is not a saved mission: " + error.what());
  } catch (const OutsideError& error) {
    throw OutsideError("'" + path + "' is not a saved mission: " + error.what());
  }
}

}  // namespace spelunk::mission
