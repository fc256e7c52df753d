#include "spelunk/evaluation/tour_survey.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <queue>
#include <unordered_map>
#include <utility>

#include "spelunk/common/sensor_model.h"
#include "write_file.h"

namespace spelunk::evaluation {
namespace {

constexpr std::size_t kPointsApart = 4;  // of a way; the positions between them are left out

/// More room than this around the robot's box is no better.
constexpr float kRoomy_m = 1.2F;
constexpr float kRoomClass_m = 0.3F;

/// Of a robot that must turn to see all round; no camera's field is narrower than their spacing.
constexpr int kHeadings = 16;

/// A metre of way without any room counts as so many more.
constexpr double kNarrowCost = 3.0;

/// The positions of a lattice through the start where the robot has room, joined to it.
class Lattice {
 public:
  Lattice(const sim::WorldMesh& mesh, const sim::MeshScene& scene, const Pose& start,
          const RobotModel& robot, const SurveyParams& params)
      : step_m_(stepFor(robot, params)) {
    const AxisAlignedBox bounds = mesh.bounds();
    const auto cellsTo = [&](const Eigen::Vector3d& corner) -> Eigen::Vector3i {
      return ((corner - start.position).array() / step_m_.array()).floor().cast<int>();
    };
    const Eigen::Vector3i first = cellsTo(bounds.min);
    shape_.size = cellsTo(bounds.max) - first + Eigen::Vector3i::Ones();
    corner_ = start.position + (first.cast<double>().array() * step_m_.array()).matrix();
    room_m_.assign(shape_.count(), kUnseen);
    const auto roomAt = [&](const Eigen::Vector3d& position) {
      const Eigen::Vector3d centre = position + robot.box_lift_m * Eigen::Vector3d::UnitZ();
      const auto room = static_cast<float>(scene.boxDistance(centre, robot.box_m, kRoomy_m));
      return room < params.margin_m ? kNone : room;
    };
    spread(-first, roomAt);
  }

  /// In the order of a breadth-first search from the start, which comes first.
  [[nodiscard]] const std::vector<std::size_t>& positions() const { return positions_; }

  [[nodiscard]] Eigen::Vector3d at(std::size_t number) const {
    return corner_ + (shape_.cellAt(number).cast<double>().array() * step_m_.array()).matrix();
  }

  /// Between the robot's box at a position and the mesh, at most kRoomy_m.
  [[nodiscard]] float room(std::size_t number) const { return room_m_[number]; }

  /// Calls `visit` with the number and distance of each of the up to 26 neighbours with room.
  template <class Visit>
  void forEachNeighbour(std::size_t number, Visit&& visit) const {
    const Eigen::Vector3i cell = shape_.cellAt(number);
    forEachAround(cell, [&](const Eigen::Vector3i& other) {
      const std::size_t place = shape_.offsetOf(other);
      if (room_m_[place] >= 0.0F)
        visit(place, ((other - cell).cast<double>().array() * step_m_.array()).matrix().norm());
    });
  }

 private:
  static constexpr float kUnseen = -2.0F;
  static constexpr float kNone = -1.0F;

  /// Boxes at neighbouring positions overlap, so that no thin wall stands between them.
  static Eigen::Vector3d stepFor(const RobotModel& robot, const SurveyParams& params) {
    return Eigen::Vector3d(params.step_m, params.step_m, params.rise_m).cwiseMin(robot.box_m);
  }

  template <class Visit>
  void forEachAround(const Eigen::Vector3i& cell, Visit&& visit) const {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const Eigen::Vector3i other = cell + Eigen::Vector3i(x, y, z);
          if (shape_.contains(other) && other != cell) visit(other);
        }
  }

  /// The start has room by definition: the robot stands there.
  template <class Room>
  void spread(const Eigen::Vector3i& start, const Room& roomAt) {
    positions_.push_back(shape_.offsetOf(start));
    room_m_[positions_.front()] = std::max(0.0F, roomAt(at(positions_.front())));
    for (std::size_t next = 0; next < positions_.size(); ++next)
      forEachAround(shape_.cellAt(positions_[next]), [&](const Eigen::Vector3i& other) {
        const std::size_t number = shape_.offsetOf(other);
        if (room_m_[number] != kUnseen) return;
        room_m_[number] = roomAt(at(number));
        if (room_m_[number] >= 0.0F) positions_.push_back(number);
      });
  }

  Eigen::Vector3d step_m_;
  Eigen::Vector3d corner_;
  GridShape shape_;
  std::vector<float> room_m_;  ///< Or kUnseen or kNone.
  std::vector<std::size_t> positions_;
};

class Surveyor {
 public:
  Surveyor(const sim::WorldMesh& mesh, const sim::MeshScene& scene, const Pose& start,
           const RobotModel& robot, const SurveyParams& params)
      : scene_(scene),
        robot_(robot),
        params_(params),
        targets_(reachableSpace(mesh, start.position), params.target_m),
        lattice_(mesh, scene, start, robot, params) {}

  TourSurvey survey() {
    result_.speed_mps = robot_.speed_max_mps;
    result_.volumes_m3 = targets_.volumes_m3();
    chooseOutlooks();
    for (std::uint32_t outlook = 0; outlook < outlooks_.size(); ++outlook) findWays(outlook);
    for (const Eigen::Vector3d& outlook : result_.outlooks) look(outlook);
    return std::move(result_);
  }

 private:
  /// What is known of a position while ways from one outlook are searched.
  struct Reached {
    double cost = std::numeric_limits<double>::infinity();  ///< Metres, narrow ones counted more.
    double metres = 0.0;
    std::size_t before = 0;
    bool is_final = false;
  };
  using Reach = std::unordered_map<std::size_t, Reached>;

  /// The start, then where there is most room, so that tours keep to the middle of passages.
  void chooseOutlooks() {
    std::vector<std::size_t> positions = lattice_.positions();
    const auto roomClass = [this](std::size_t position) {
      return static_cast<int>(lattice_.room(position) / kRoomClass_m);
    };
    std::stable_sort(positions.begin() + 1, positions.end(),
                     [&](std::size_t a, std::size_t b) { return roomClass(a) > roomClass(b); });
    for (const std::size_t position : positions)
      if (!isOverlooked(lattice_.at(position))) addOutlook(position);
  }

  void addOutlook(std::size_t position) {
    number_of_.emplace(position, static_cast<std::uint32_t>(outlooks_.size()));
    outlooks_.push_back(position);
    result_.outlooks.push_back(lattice_.at(position));
  }

  /// Whether an outlook near a place sees it.
  [[nodiscard]] bool isOverlooked(const Eigen::Vector3d& place) const {
    return std::any_of(
        result_.outlooks.begin(), result_.outlooks.end(), [&](const Eigen::Vector3d& outlook) {
          const double gap = (place - outlook).norm();
          return gap < params_.outlook_m &&
                 (gap < params_.step_m || !scene_.castRay(outlook, (place - outlook) / gap, gap));
        });
  }

  /// Dijkstra as far as way_max_m; notes the ways to outlooks of higher numbers.
  void findWays(std::uint32_t outlook) {
    Reach reach;
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    reach[outlooks_[outlook]].cost = 0.0;
    open.emplace(0.0, outlooks_[outlook]);
    while (!open.empty()) {
      const auto [cost, position] = open.top();
      open.pop();
      if (std::exchange(reach[position].is_final, true)) continue;
      const double metres = reach[position].metres;
      const auto other = number_of_.find(position);
      if (other != number_of_.end() && other->second > outlook)
        note(outlook, other->second, metres, reach);
      lattice_.forEachNeighbour(position, [&, base = cost](std::size_t next, double step_m) {
        Reached& there = reach[next];
        const double total = base + step_m * narrowness(next);
        if (metres + step_m > params_.way_max_m || total >= there.cost) return;
        there.cost = total;
        there.metres = metres + step_m;
        there.before = position;
        open.emplace(total, next);
      });
    }
  }

  /// What a metre to a position counts.
  [[nodiscard]] double narrowness(std::size_t position) const {
    return 1.0 + kNarrowCost * (1.0 - lattice_.room(position) / kRoomy_m);
  }

  void note(std::uint32_t from, std::uint32_t to, double metres, Reach& reach) {
    TourSurvey::Way way{from, to, metres, {result_.outlooks[to]}};
    std::size_t count = 0;
    for (std::size_t at = outlooks_[to]; at != outlooks_[from]; at = reach[at].before)
      if (++count % kPointsApart == 0) way.points.push_back(lattice_.at(at));
    way.points.push_back(result_.outlooks[from]);
    std::reverse(way.points.begin(), way.points.end());
    result_.ways.push_back(std::move(way));
  }

  void look(const Eigen::Vector3d& outlook) {
    std::vector<std::uint8_t> seen((targets_.size() + 7) / 8, 0);
    for (const SensorModel& sensor : robot_.sensor_models) {
      const int headings = seesAllAround(sensor) ? 1 : kHeadings;
      for (int heading = 0; heading < headings; ++heading)
        look(sensor, {outlook, 2.0 * M_PI * heading / headings}, seen);
    }
    result_.seen.push_back(std::move(seen));
  }

  void look(const SensorModel& sensor, const Pose& from, std::vector<std::uint8_t>& seen) const {
    const Eigen::Isometry3d T_world_sensor = T_world_base(from) * T_base_sensor(sensor);
    const Eigen::Vector3d origin = T_world_sensor.translation();
    const Eigen::Matrix3f turn = T_world_sensor.linear().cast<float>();
    std::vector<Eigen::Vector3f> directions = rayDirections(sensor);
    for (Eigen::Vector3f& direction : directions) direction = turn * direction;
    std::vector<float> ranges;
    scene_.castFan(origin.cast<float>(), directions, static_cast<float>(sensor.range_max_m),
                   ranges);
    for (std::size_t i = 0; i < directions.size(); ++i)
      mark(origin, directions[i].cast<double>(), ranges[i], seen);
  }

  void mark(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range_m,
            std::vector<std::uint8_t>& seen) const {
    const double step_m = 0.5 * targets_.edge();
    for (double along = 0.0; along <= range_m; along += step_m)
      if (const auto target = targets_.find(origin + along * direction))
        seen[*target >> 3] = static_cast<std::uint8_t>(seen[*target >> 3] | 1U << (*target & 7));
  }

  const sim::MeshScene& scene_;
  const RobotModel& robot_;
  SurveyParams params_;
  TargetVoxels targets_;
  Lattice lattice_;
  std::vector<std::size_t> outlooks_;  ///< Their positions.
  std::unordered_map<std::size_t, std::uint32_t> number_of_;
  TourSurvey result_;
};

nlohmann::json toJson(const std::vector<Eigen::Vector3d>& points) {
  nlohmann::json json = nlohmann::json::array();
  for (const Eigen::Vector3d& point : points) json.push_back({point.x(), point.y(), point.z()});
  return json;
}

}  // namespace

TourSurvey surveyForTour(const sim::WorldMesh& mesh, const sim::MeshScene& scene, const Pose& start,
                         const RobotModel& robot, const SurveyParams& params) {
  return Surveyor(mesh, scene, start, robot, params).survey();
}

void writeSurvey(const TourSurvey& survey, const std::string& folder) {
  nlohmann::json json;
  json["speed_mps"] = survey.speed_mps;
  json["outlooks"] = toJson(survey.outlooks);
  json["ways"] = nlohmann::json::array();
  for (const TourSurvey::Way& way : survey.ways)
    json["ways"].push_back({{"from", way.from},
                            {"to", way.to},
                            {"length_m", way.length_m},
                            {"points", toJson(way.points)}});
  json["volumes_m3"] = survey.volumes_m3;
  writeFile(folder + "/survey.json", json.dump());
  std::string rows;
  for (const auto& row : survey.seen) rows.append(row.begin(), row.end());
  writeFile(folder + "/survey_seen.bin", rows);
}

}  // namespace spelunk::evaluation
