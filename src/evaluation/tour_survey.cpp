#include "spelunk/evaluation/tour_survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "spelunk/common/contract.h"
#include "spelunk/common/sensor_model.h"

namespace spelunk::evaluation {
namespace {

constexpr double kWayStep_m = 0.25;  // between the places of a way that are looked at

class Surveyor {
 public:
  Surveyor(const sim::WorldMesh& mesh, const sim::MeshScene& scene, const Pose& start,
           const RobotModel& robot, const SurveyParams& params)
      : scene_(scene),
        start_(start),
        robot_(robot),
        params_(params),
        targets_(reachableSpace(mesh, start.position), params.target_m) {
    for (const SensorModel& sensor : robot.sensor_models)
      directions_.push_back(rayDirections(sensor));
  }

  TourSurvey survey() {
    result_.volumes_m3 = targets_.volumes_m3();
    spread();
    chooseOutlooks();
    for (const std::uint32_t outlook : result_.outlooks) look(result_.places[outlook]);
    return std::move(result_);
  }

 private:
  using Place = std::array<int, 3>;

  [[nodiscard]] Eigen::Vector3d positionOf(const Place& place) const {
    return start_.position + Eigen::Vector3d(params_.spacing_m * place[0],
                                             params_.spacing_m * place[1],
                                             params_.layer_m * place[2]);
  }

  [[nodiscard]] bool hasRoom(const Eigen::Vector3d& position) const {
    const Eigen::Vector3d centre = position + robot_.box_lift_m * Eigen::Vector3d::UnitZ();
    return scene_.boxDistance(centre, robot_.box_m, params_.margin_m + 0.01) >= params_.margin_m;
  }

  [[nodiscard]] bool isOpen(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    const double length = (to - from).norm();
    const int steps = static_cast<int>(std::ceil(length / kWayStep_m));
    for (int k = 1; k <= steps; ++k)
      if (!hasRoom(from + (to - from) * k / steps)) return false;
    return !scene_.castRay(from, (to - from) / length, length);
  }

  /// The number of a place, added if it is new and has room.
  [[nodiscard]] std::optional<std::uint32_t> numberAt(const Place& place) {
    const auto [entry, is_new] = numbers_.try_emplace(place, std::nullopt);
    if (!is_new) return entry->second;
    const Eigen::Vector3d position = positionOf(place);
    if (!targets_.find(position) || !hasRoom(position)) return std::nullopt;
    entry->second = static_cast<std::uint32_t>(result_.places.size());
    result_.places.push_back(position);
    return entry->second;
  }

  /// Breadth first from the start; a place is added when an open way leads to it.
  void spread() {
    numbers_[{0, 0, 0}] = 0;
    result_.places.push_back(start_.position);
    std::deque<Place> open{{0, 0, 0}};
    while (!open.empty()) {
      const Place place = open.front();
      open.pop_front();
      for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
          for (int x = -1; x <= 1; ++x)
            if (x != 0 || y != 0 || z != 0)
              join(place, {place[0] + x, place[1] + y, place[2] + z}, open);
    }
  }

  void join(const Place& place, const Place& other, std::deque<Place>& open) {
    const Eigen::Vector3d from = positionOf(place);
    const Eigen::Vector3d to = positionOf(other);
    const auto known = numbers_.find(other);
    if (known != numbers_.end() && (!known->second || *known->second < *numbers_[place])) return;
    const bool is_known = known != numbers_.end();
    if (!targets_.find(to) || !hasRoom(to)) {
      numbers_[other] = std::nullopt;
      return;
    }
    if (!isOpen(from, to)) return;
    const auto number = numberAt(other);
    if (!number) return;
    if (!is_known) open.push_back(other);
    result_.ways.push_back({*numbers_[place], *number, (to - from).norm()});
  }

  /// In the order the places were found, so from the start outwards.
  void chooseOutlooks() {
    for (std::uint32_t place = 0; place < result_.places.size(); ++place) {
      const auto isNear = [&](std::uint32_t outlook) {
        return (result_.places[outlook] - result_.places[place]).norm() < params_.outlook_m;
      };
      if (std::none_of(result_.outlooks.begin(), result_.outlooks.end(), isNear))
        result_.outlooks.push_back(place);
    }
  }

  void look(const Eigen::Vector3d& place) {
    std::vector<std::uint8_t> seen((targets_.size() + 7) / 8, 0);
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      const SensorModel& sensor = robot_.sensor_models[k];
      const Eigen::Isometry3d T_base_sensor = spelunk::T_base_sensor(sensor);
      const Eigen::Vector3d origin = place + T_base_sensor.translation();
      std::vector<Eigen::Vector3f> turned;
      for (const Eigen::Vector3f& direction : directions_[k])
        turned.emplace_back(T_base_sensor.linear().cast<float>() * direction);
      scene_.castFan(origin.cast<float>(), turned, static_cast<float>(sensor.range_max_m), ranges_);
      for (std::size_t i = 0; i < turned.size(); ++i)
        mark(origin, turned[i].cast<double>(), ranges_[i], seen);
    }
    result_.seen.push_back(std::move(seen));
  }

  void mark(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range_m,
            std::vector<std::uint8_t>& seen) const {
    const double step_m = 0.5 * targets_.edge();
    for (double along = 0.0; along <= range_m; along += step_m)
      if (const auto target = targets_.find(origin + along * direction))
        seen[*target >> 3] = static_cast<std::uint8_t>(seen[*target >> 3] | 1U << (*target & 7));
  }

  const sim::MeshScene& scene_;
  Pose start_;
  const RobotModel& robot_;
  SurveyParams params_;
  TargetVoxels targets_;
  std::vector<std::vector<Eigen::Vector3f>> directions_;   ///< One list a sensor.
  std::map<Place, std::optional<std::uint32_t>> numbers_;  ///< None: no room there.
  std::vector<float> ranges_;
  TourSurvey result_;
};

void requireWritten(const std::ofstream& file, const std::string& path) {
  if (!file)
    throw OutsideError("cannot write '" + path + "': is the folder writable, the disk full?");
}

}  // namespace

TourSurvey surveyForTour(const sim::WorldMesh& mesh, const sim::MeshScene& scene, const Pose& start,
                         const RobotModel& robot, const SurveyParams& params) {
  return Surveyor(mesh, scene, start, robot, params).survey();
}

void writeSurvey(const TourSurvey& survey, const std::string& folder) {
  nlohmann::json json;
  for (const Eigen::Vector3d& point : survey.places)
    json["places"].push_back({point.x(), point.y(), point.z()});
  json["ways"] = nlohmann::json::array();
  for (const TourSurvey::Way& way : survey.ways)
    json["ways"].push_back({way.from, way.to, way.length_m});
  json["outlooks"] = survey.outlooks;
  json["volumes_m3"] = survey.volumes_m3;
  const std::string text_path = folder + "/survey.json";
  std::ofstream text(text_path);
  text << json.dump();
  text.flush();
  requireWritten(text, text_path);
  const std::string rows_path = folder + "/survey_seen.bin";
  std::ofstream rows(rows_path, std::ios::binary);
  for (const auto& row : survey.seen)
    rows.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size()));
  rows.flush();
  requireWritten(rows, rows_path);
}

}  // namespace spelunk::evaluation
